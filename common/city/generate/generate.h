#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/city/city.h"
#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

enum class Style : std::uint8_t { kOldTown, kGrid };

/// "old-town" and "grid".
[[nodiscard]] std::optional<Style> style_of(std::string_view name);
inline constexpr const char* kStyleNames = "old-town, grid";

struct Request {
  Style style{Style::kOldTown};
  std::uint64_t seed{1};
  double size_m{600.0};              ///< Side of the square.
  std::optional<Geodetic> origin{};  ///< Of the middle; else default_origin().
};

/// Where a city is put if nobody says where: at the latitude of a city of its kind, so that the
/// sun, satellites and magnetic field suit it. Nothing there is meant to be like it.
[[nodiscard]] Geodetic default_origin(Style style);

/// Throws std::invalid_argument for a size that check_size() refuses.
[[nodiscard]] Plan make_plan(const Request& request);

/// The city as an OSM file: the same bytes for the same request.
[[nodiscard]] std::string make_osm(const Request& request);

}  // namespace cuscus::city::generate
