#include <limits>
#include <string>

#include "common/city/import/city_parts.h"
#include "common/city/import/footprints.h"
#include "common/city/import/tag_values.h"

namespace cuscus::city {
namespace {

/// The tag's length, else the rule's; reported when it makes no sense.
template <typename Record>
double length_or(const Record& record, std::string_view key, TagNumber (*parse)(std::string_view),
                 double otherwise_m, FileReport& report) {
  const std::string_view text = record.tags[key];
  if (text.empty()) {
    return otherwise_m;
  }
  const TagNumber number = parse(text);
  if (!number.valid()) {
    report.add(Problem::kBadTreeSize, record.object, std::string{key} + "=" + std::string{text});
    return otherwise_m;
  }
  return number.value;
}

}  // namespace

std::vector<Tree> build_trees(const std::vector<TreeRecord>& records, const Site& site,
                              ImportReport& report) {
  std::vector<Tree> trees;
  trees.reserve(records.size());
  for (const TreeRecord& record : records) {
    FileReport& file = report.files[record.file];
    const Eigen::Vector2d place_m = site.place_of(record.point);
    const double crown_m =
        length_or(record, "diameter_crown", parse_crown_m, 2.0 * site.rule.crown_radius_m, file);
    trees.push_back({.foot_m = {place_m.x(), place_m.y(), site.ground_m(place_m)},
                     .height_m = length_or(record, "height", parse_tree_height_m,
                                           site.rule.tree_height_m, file),
                     .crown_radius_m = crown_m / 2.0});
  }
  report.figures.trees = trees.size();
  return trees;
}

std::vector<Wood> build_woods(const std::vector<AreaRecord>& areas, const Site& site,
                              ImportReport& report) {
  std::vector<Wood> woods;
  for (const AreaRecord& area : areas) {
    if (area.kind != AreaKind::kWood) {
      continue;
    }
    const double height_m = length_or(area, "height", parse_tree_height_m, site.rule.wood_height_m,
                                      report.files[area.file]);
    for (const Footprint& whole : footprints_of(area, site, report)) {
      for (Footprint& piece : site.box ? clip(whole, *site.box) : std::vector{whole}) {
        double lowest_m = std::numeric_limits<double>::max();
        double highest_m = std::numeric_limits<double>::lowest();
        for (const auto& corner : piece.outer) {
          lowest_m = std::min(lowest_m, site.ground_m(corner));
          highest_m = std::max(highest_m, site.ground_m(corner));
        }
        // Flat below and above, so that on a slope it has all of its trees.
        woods.push_back(
            {.footprint = std::move(piece), .bottom_m = lowest_m, .top_m = highest_m + height_m});
      }
    }
  }
  report.figures.woods = woods.size();
  return woods;
}

}  // namespace cuscus::city
