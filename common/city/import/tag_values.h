#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/city/city.h"

/// What OpenStreetMap's tags mean. Their values are free text; what is none of the forms below is a
/// fault, and nothing is guessed from it.
namespace cuscus::city {

enum class TagFault : std::uint8_t {
  kNone,
  kNotANumber,  ///< "3 storeys", "10-12", "12;15", "nan".
  kTooSmall,    ///< Negative, or 0 where nothing can be 0.
  kTooLarge,    ///< Larger than anything that has been built.
};

/// A number read from a tag. Without a fault `value` is within the limits of its kind.
struct TagNumber {
  double value{0.0};
  TagFault fault{TagFault::kNone};

  [[nodiscard]] bool valid() const noexcept { return fault == TagFault::kNone; }
};

/// The tallest building has 828 m and 163 floors (Burj Khalifa).
inline constexpr double kTallestBuilding_m = 1000.0;
inline constexpr double kMostLevels = 200.0;
/// The tallest tree has 116 m (Hyperion); its crown has the size of a block at most.
inline constexpr double kTallestTree_m = 130.0;
inline constexpr double kWidestCrown_m = 100.0;
inline constexpr double kWidestStreet_m = 200.0;

// Lengths are "12", "12.5", "12,5" (a decimal comma), with or without "m", "metres", "meters", "ft"
// or "feet", and a space before it; or feet and inches, "12'" and "12'6"" with an inch sign.

/// `height` and `roof:height` of a building [m]: above 0, up to kTallestBuilding_m.
[[nodiscard]] TagNumber parse_height_m(std::string_view text);
/// `min_height` [m]: from 0 to kTallestBuilding_m.
[[nodiscard]] TagNumber parse_min_height_m(std::string_view text);
/// `building:levels`: above 0, up to kMostLevels; halves and the like are allowed.
[[nodiscard]] TagNumber parse_levels(std::string_view text);
/// `building:min_level` and `roof:levels`: from 0 to kMostLevels.
[[nodiscard]] TagNumber parse_levels_from_zero(std::string_view text);
/// `height` of a tree or wood [m].
[[nodiscard]] TagNumber parse_tree_height_m(std::string_view text);
/// `diameter_crown` [m].
[[nodiscard]] TagNumber parse_crown_m(std::string_view text);
/// `width` of a street [m].
[[nodiscard]] TagNumber parse_street_width_m(std::string_view text);
/// `lanes`: above 0, up to as many as fit kWidestStreet_m.
[[nodiscard]] TagNumber parse_lanes(std::string_view text);

/// `building:material`; none: a material that we know no wall of.
[[nodiscard]] std::optional<Material> parse_material(std::string_view text);

}  // namespace cuscus::city
