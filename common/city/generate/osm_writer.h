#pragma once

#include <string>

#include "common/city/city.h"
#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

/// The plan as an OSM file (XML, version 0.6), on WGS-84 with the plan's (0, 0) at `origin`, whose
/// height does not matter: OSM knows none. Read back by a projection to ENU at `origin`, nodes have
/// the plan's metres to 0.1 mm. The file's bounds are symmetric about the origin. Buildings with
/// courtyards are multipolygon relations, parts are `building:part`. The same bytes for the same
/// plan.
[[nodiscard]] std::string osm_text(const Plan& plan, const Geodetic& origin);

/// What the file's root element names as its generator.
inline constexpr const char* kOsmGenerator = "cuscus city generate";

}  // namespace cuscus::city::generate
