#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/city/import/city_parts.h"
#include "common/city/import/footprints.h"
#include "common/city/import/tag_values.h"

namespace cuscus::city {
namespace {

constexpr double kLaneWidth_m = 3.5;

/// Widths from kerb to kerb where a map gives none: our own choice, after common lane numbers. A
/// value of highway that is not here is no street that is there (proposed, construction, platform).
std::optional<double> class_width_m(std::string_view highway) {
  static constexpr auto kWidths = std::to_array<std::pair<std::string_view, double>>({
      {"motorway", 14.0},     {"trunk", 14.0},         {"primary", 10.5},      {"secondary", 10.5},
      {"tertiary", 7.0},      {"unclassified", 7.0},   {"residential", 7.0},   {"road", 7.0},
      {"living_street", 5.0}, {"pedestrian", 5.0},     {"motorway_link", 5.0}, {"trunk_link", 5.0},
      {"primary_link", 5.0},  {"secondary_link", 5.0}, {"tertiary_link", 5.0}, {"service", 4.0},
      {"busway", 4.0},        {"track", 3.0},          {"cycleway", 2.5},      {"footway", 2.0},
      {"path", 2.0},          {"steps", 2.0},          {"bridleway", 2.0},
  });
  const auto found =
      std::ranges::find(kWidths, highway, &std::pair<std::string_view, double>::first);
  return found != kWidths.end() ? std::optional{found->second} : std::nullopt;
}

/// The tag's number; reported when it makes no sense.
std::optional<double> street_number(const StreetRecord& street, std::string_view key,
                                    TagNumber (*parse)(std::string_view), FileReport& report) {
  const std::string_view text = street.tags[key];
  if (text.empty()) {
    return std::nullopt;
  }
  const TagNumber number = parse(text);
  if (!number.valid()) {
    report.add(Problem::kBadWidth, street.object, std::string{key} + "=" + std::string{text});
    return std::nullopt;
  }
  return number.value;
}

double width_m(const StreetRecord& street, double by_class_m, FileReport& report) {
  if (const auto width = street_number(street, "width", parse_street_width_m, report)) {
    return *width;
  }
  if (const auto lanes = street_number(street, "lanes", parse_lanes, report)) {
    return *lanes * kLaneWidth_m;
  }
  return by_class_m;
}

/// In a tunnel, in a building, or under the ground.
bool is_hidden(const Tags& tags) {
  const auto set = [&](std::string_view key) { return !tags[key].empty() && tags[key] != "no"; };
  return set("tunnel") || set("indoor") || tags["location"] == "underground";
}

}  // namespace

std::vector<Street> build_streets(const std::vector<StreetRecord>& records, const Site& site,
                                  ImportReport& report) {
  std::vector<Street> streets;
  for (const StreetRecord& record : records) {
    const auto by_class_m = class_width_m(record.tags["highway"]);
    if (!by_class_m || record.tags["area"] == "yes") {
      continue;
    }
    FileReport& file = report.files[record.file];
    if (is_hidden(record.tags)) {
      file.add(Problem::kUnderGround, record.object);
      continue;
    }
    Street street{.osm_id = record.object.id,
                  .name = std::string{record.tags["name"]},
                  .axis_m = {},
                  .width_m = width_m(record, *by_class_m, file)};
    std::vector<Eigen::Vector2d> axis_m;
    for (const GeoPoint& point : record.points) {
      axis_m.push_back(site.place_of(point));
    }
    auto pieces =
        site.box ? clip_line(axis_m, *site.box) : std::vector<std::vector<Eigen::Vector2d>>{axis_m};
    for (auto& piece : pieces) {
      street.axis_m = std::move(piece);
      for (std::size_t i = 1; i < street.axis_m.size(); ++i) {
        report.figures.street_length_m += (street.axis_m[i] - street.axis_m[i - 1]).norm();
      }
      streets.push_back(street);
    }
  }
  report.figures.streets = streets.size();
  return streets;
}

}  // namespace cuscus::city
