#include "common/city/import/tag_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

namespace cuscus::city {
namespace {

constexpr double kFoot_m = 0.3048;  // exact: international foot
constexpr double kInch_m = 0.0254;
constexpr double kInchesPerFoot = 12.0;
constexpr double kLane_m = 3.5;

struct Limits {
  double lowest;
  bool lowest_allowed;
  double highest;
};

constexpr TagNumber kNotANumber{.fault = TagFault::kNotANumber};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Takes a decimal number off the front of `text`.
std::optional<double> take_number(std::string_view& text) {
  constexpr std::size_t kLongest = 40;
  const auto end = text.find_first_not_of("+-.,0123456789eE");
  std::string number{text.substr(0, std::min(end, kLongest))};
  // A comma is a decimal comma; with a point beside it, it may be anything.
  if (const auto comma = number.find(','); comma != std::string::npos) {
    number[comma] = '.';
  }
  double value = 0.0;
  const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error == std::errc::result_out_of_range) {
    value = number.front() == '-' ? -HUGE_VAL : HUGE_VAL;  // or too near 0, which is as absurd
  } else if (error != std::errc{}) {
    return std::nullopt;
  }
  text.remove_prefix(static_cast<std::size_t>(stop - number.data()));
  return value;
}

std::optional<double> take_inches(std::string_view text) {
  if (text.empty()) {
    return 0.0;
  }
  const auto inches = take_number(text);
  if (!inches || *inches < 0.0 || *inches >= kInchesPerFoot || (text != "\"" && text != "''")) {
    return std::nullopt;
  }
  return *inches;
}

/// Metres of a length of any size.
std::optional<double> length_m(std::string_view text) {
  text = trimmed(text);
  const auto number = take_number(text);
  if (!number) {
    return std::nullopt;
  }
  if (!text.empty() && text.front() == '\'') {
    const auto inches = take_inches(trimmed(text.substr(1)));
    return inches ? std::optional{*number * kFoot_m + std::copysign(*inches, *number) * kInch_m}
                  : std::nullopt;
  }
  text = trimmed(text);
  static constexpr std::array<std::string_view, 6> kMetres{"",      "m",      "metre",
                                                           "meter", "metres", "meters"};
  static constexpr std::array<std::string_view, 3> kFeet{"ft", "foot", "feet"};
  if (std::ranges::find(kMetres, text) != kMetres.end()) {
    return number;
  }
  if (std::ranges::find(kFeet, text) != kFeet.end()) {
    return *number * kFoot_m;
  }
  return std::nullopt;
}

std::optional<double> plain_number(std::string_view text) {
  text = trimmed(text);
  const auto number = take_number(text);
  return text.empty() ? number : std::nullopt;
}

TagNumber within(std::optional<double> value, const Limits& limits) {
  if (!value) {
    return kNotANumber;
  }
  if (*value < limits.lowest || (*value == limits.lowest && !limits.lowest_allowed)) {
    return {.fault = TagFault::kTooSmall};
  }
  if (*value > limits.highest) {
    return {.fault = TagFault::kTooLarge};
  }
  return {.value = *value};
}

constexpr Limits above_zero(double highest) { return {0.0, false, highest}; }
constexpr Limits from_zero(double highest) { return {0.0, true, highest}; }

}  // namespace

TagNumber parse_height_m(std::string_view text) {
  return within(length_m(text), above_zero(kTallestBuilding_m));
}

TagNumber parse_min_height_m(std::string_view text) {
  return within(length_m(text), from_zero(kTallestBuilding_m));
}

TagNumber parse_levels(std::string_view text) {
  return within(plain_number(text), above_zero(kMostLevels));
}

TagNumber parse_levels_from_zero(std::string_view text) {
  return within(plain_number(text), from_zero(kMostLevels));
}

TagNumber parse_tree_height_m(std::string_view text) {
  return within(length_m(text), above_zero(kTallestTree_m));
}

TagNumber parse_crown_m(std::string_view text) {
  return within(length_m(text), above_zero(kWidestCrown_m));
}

TagNumber parse_street_width_m(std::string_view text) {
  return within(length_m(text), above_zero(kWidestStreet_m));
}

TagNumber parse_lanes(std::string_view text) {
  return within(plain_number(text), above_zero(kWidestStreet_m / kLane_m));
}

std::optional<Material> parse_material(std::string_view text) {
  // The values of OpenStreetMap's taginfo with more than some hundred uses.
  static constexpr auto kKnown = std::to_array<std::pair<std::string_view, Material>>({
      {"adobe", Material::kBrick},
      {"aluminium", Material::kMetal},
      {"bamboo", Material::kWood},
      {"brick", Material::kBrick},
      {"bricks", Material::kBrick},
      {"cement_block", Material::kConcrete},
      {"concrete", Material::kConcrete},
      {"copper", Material::kMetal},
      {"glass", Material::kGlass},
      {"granite", Material::kStone},
      {"limestone", Material::kStone},
      {"loam", Material::kBrick},
      {"marble", Material::kStone},
      {"metal", Material::kMetal},
      {"metal_plates", Material::kMetal},
      {"mirror", Material::kGlass},
      {"mud", Material::kBrick},
      {"reinforced_concrete", Material::kConcrete},
      {"sandstone", Material::kStone},
      {"slate", Material::kStone},
      {"stainless_steel", Material::kMetal},
      {"steel", Material::kMetal},
      {"stone", Material::kStone},
      {"timber_framing", Material::kWood},
      {"tin", Material::kMetal},
      {"wood", Material::kWood},
      {"zinc", Material::kMetal},
  });
  const auto found = std::ranges::find(kKnown, text, &std::pair<std::string_view, Material>::first);
  return found != kKnown.end() ? std::optional{found->second} : std::nullopt;
}

}  // namespace cuscus::city
