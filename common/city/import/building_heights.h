#pragma once

#include <optional>

#include "common/city/city.h"
#include "common/city/import/import_options.h"
#include "common/city/import/import_report.h"
#include "common/city/import/osm_records.h"

namespace cuscus::city {

/// A top above the ground, and how it is known.
struct TopHeight {
  double top_m{0.0};
  HeightSource source{HeightSource::kRule};
};

/// What the tags say: `height`, else `building:levels` and the roof (`roof:height`, else
/// `roof:levels`, neither of which the levels include). None: nothing usable.
[[nodiscard]] std::optional<TopHeight> tagged_top(const AreaRecord& area, const CityRule& rule,
                                                  FileReport& report);

/// What the rule says: a function of the seed and the object's id alone.
[[nodiscard]] TopHeight top_by_rule(const ObjectId& object, const CityRule& rule);

/// Where a building or part begins above the ground: `min_height`, else `building:min_level`, else
/// 0; 0 too when that is not below `top_m`. A canopy (building=roof) is a plate under its top.
[[nodiscard]] double bottom_m(const AreaRecord& area, double top_m, const CityRule& rule,
                              FileReport& report);

}  // namespace cuscus::city
