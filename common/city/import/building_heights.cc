#include "common/city/import/building_heights.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "common/city/import/tag_values.h"
#include "common/random/counter_stream.h"

namespace cuscus::city {
namespace {

constexpr double kCanopy_m = 0.3;
constexpr std::uint16_t kHeightPurpose = 0x6369;  // of the streams of a scenario's seed

/// The tag's number, or none, reported when the tag is there and makes no sense.
std::optional<double> building_number(const AreaRecord& area, std::string_view key,
                                      TagNumber (*parse)(std::string_view), Problem problem,
                                      FileReport& report) {
  const std::string_view text = area.tags[key];
  if (text.empty()) {
    return std::nullopt;
  }
  const TagNumber number = parse(text);
  if (!number.valid()) {
    report.add(problem, area.object, std::string{key} + "=" + std::string{text});
    return std::nullopt;
  }
  return number.value;
}

}  // namespace

std::optional<TopHeight> tagged_top(const AreaRecord& area, const CityRule& rule,
                                    FileReport& report) {
  if (const auto height_m =
          building_number(area, "height", parse_height_m, Problem::kBadHeight, report)) {
    return TopHeight{*height_m, HeightSource::kTag};
  }
  const auto levels =
      building_number(area, "building:levels", parse_levels, Problem::kBadLevels, report);
  if (!levels) {
    return std::nullopt;
  }
  double roof_m = 0.0;
  if (const auto height_m =
          building_number(area, "roof:height", parse_min_height_m, Problem::kBadRoof, report)) {
    roof_m = *height_m;
  } else if (const auto roof_levels = building_number(area, "roof:levels", parse_levels_from_zero,
                                                      Problem::kBadRoof, report)) {
    roof_m = *roof_levels * rule.level_m;
  }
  return TopHeight{*levels * rule.level_m + roof_m, HeightSource::kLevels};
}

TopHeight top_by_rule(const ObjectId& object, const CityRule& rule) {
  const auto id = static_cast<std::uint64_t>(std::abs(object.id));
  const random::CounterStream draws{
      rule.seed, random::stream_id(kHeightPurpose, static_cast<std::uint32_t>(id),
                                   static_cast<std::uint16_t>(id >> 32U))};
  // A way and a relation may have one number.
  const double draw = draws.uniform(static_cast<std::uint64_t>(object.type));
  return {rule.heights.lowest_m + draw * (rule.heights.highest_m - rule.heights.lowest_m),
          HeightSource::kRule};
}

double bottom_m(const AreaRecord& area, double top_m, const CityRule& rule, FileReport& report) {
  double bottom_m = 0.0;
  if (const auto height_m =
          building_number(area, "min_height", parse_min_height_m, Problem::kBadMinHeight, report)) {
    bottom_m = *height_m;
  } else if (const auto levels = building_number(area, "building:min_level", parse_levels_from_zero,
                                                 Problem::kBadMinHeight, report)) {
    bottom_m = *levels * rule.level_m;
  }
  if (bottom_m >= top_m) {
    report.add(Problem::kBottomAboveTop, area.object,
               "from " + std::to_string(bottom_m) + " m to " + std::to_string(top_m) + " m");
    bottom_m = 0.0;
  }
  if (area.tags["building"] == "roof" || area.tags["building:part"] == "roof") {
    bottom_m = std::max(bottom_m, top_m - kCanopy_m);
  }
  return bottom_m;
}

}  // namespace cuscus::city
