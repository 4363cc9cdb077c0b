#include "orchestrator/app/city_report.h"

#include <fmt/core.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

namespace cuscus::orchestrator {
namespace {

using Json = nlohmann::ordered_json;

/// As the map's web site names a building.
std::string building_text(std::int64_t osm_id) {
  return city::text_of(
      {osm_id < 0 ? city::ObjectType::kRelation : city::ObjectType::kWay, std::abs(osm_id)});
}

std::string findings_text(const city::FileReport& file, bool left_out) {
  std::string text;
  for (std::size_t i = 0; i < city::kProblems; ++i) {
    const auto problem = static_cast<city::Problem>(i);
    const city::Finding& finding = file.of(problem);
    if (finding.count == 0 || city::leaves_out(problem) != left_out) {
      continue;
    }
    std::string examples;
    for (const auto& example : finding.examples) {
      examples += fmt::format("{}{}{}", examples.empty() ? "" : ", ", city::text_of(example.object),
                              example.detail.empty() ? "" : " (" + example.detail + ")");
    }
    text += fmt::format("    {:>6}  {}: {}{}\n", finding.count, city::text_of(problem).line,
                        examples, finding.count > finding.examples.size() ? ", ..." : "");
  }
  return text;
}

std::string file_text(const city::FileReport& file) {
  std::string text = fmt::format("{}: {} nodes, {} ways, {} relations\n", file.file, file.nodes,
                                 file.ways, file.relations);
  const std::string left_out = findings_text(file, true);
  const std::string ignored = findings_text(file, false);
  if (!left_out.empty()) {
    text += "  left out:\n" + left_out;
  }
  if (!ignored.empty()) {
    text += "  in the city, but for a value or in another form:\n" + ignored;
  }
  if (left_out.empty() && ignored.empty()) {
    text += "  nothing was dropped\n";
  }
  return text;
}

Json findings_json(const city::FileReport& file) {
  Json findings = Json::array();
  for (std::size_t i = 0; i < city::kProblems; ++i) {
    const auto problem = static_cast<city::Problem>(i);
    const city::Finding& finding = file.of(problem);
    if (finding.count == 0) {
      continue;
    }
    Json examples = Json::array();
    for (const auto& example : finding.examples) {
      examples.push_back({{"object", city::text_of(example.object)}, {"detail", example.detail}});
    }
    findings.push_back({{"problem", city::text_of(problem).key},
                        {"left_out", city::leaves_out(problem)},
                        {"count", finding.count},
                        {"examples", std::move(examples)}});
  }
  return findings;
}

Json buildings_json(const city::CityFigures& figures) {
  return {{"count", figures.buildings},
          {"outline_areas", figures.building_areas},
          {"part_areas", figures.part_areas},
          {"prisms", figures.prisms},
          {"footprint_m2", figures.footprint_m2},
          {"height_from_tag", figures.height_from_tag},
          {"height_from_levels", figures.height_from_levels},
          {"height_from_rule", figures.height_from_rule},
          {"mean_height_m", figures.mean_height_m},
          {"tallest",
           {{"height_m", figures.tallest_m},
            {"object", building_text(figures.tallest_osm_id)},
            {"name", figures.tallest_name}}}};
}

}  // namespace

std::string city_text(const city::ImportedCity& imported) {
  const city::City& city = imported.city;
  const city::CityFigures& figures = imported.report.figures;
  const Eigen::Vector2d size_m = city.north_east_m - city.south_west_m;
  std::string text = fmt::format(
      "city: {:.0f} m by {:.0f} m around {:.6f}, {:.6f} (latitude, "
      "longitude)\n",
      size_m.x(), size_m.y(), city.origin.latitude_deg, city.origin.longitude_deg);
  text +=
      fmt::format("buildings: {} of {} outlines and {} parts, {} prisms, {:.4g} km2 of ground\n",
                  figures.buildings, figures.building_areas, figures.part_areas, figures.prisms,
                  figures.footprint_m2 * 1e-6);
  text += fmt::format("heights: {} tagged, {} from levels, {} by the rule; mean {:.1f} m\n",
                      figures.height_from_tag, figures.height_from_levels, figures.height_from_rule,
                      figures.mean_height_m);
  text += fmt::format("tallest: {:.1f} m, {}{}\n", figures.tallest_m,
                      building_text(figures.tallest_osm_id),
                      figures.tallest_name.empty() ? "" : " (" + figures.tallest_name + ")");
  text += fmt::format("streets: {}, {:.1f} km; trees: {}; woods: {}\n", figures.streets,
                      figures.street_length_m * 1e-3, figures.trees, figures.woods);
  if (city.terrain) {
    text += fmt::format("terrain: {} by {} points, {:.0f} m apart\n", city.terrain->columns,
                        city.terrain->rows, city.terrain->cell_m);
  }
  for (const std::string& remark : imported.report.remarks) {
    text += "note: " + remark + "\n";
  }
  for (const city::FileReport& file : imported.report.files) {
    text += file_text(file);
  }
  return text + "map data: © OpenStreetMap contributors, ODbL, where the files are theirs\n";
}

Json city_json(const city::ImportedCity& imported) {
  const city::City& city = imported.city;
  const city::CityFigures& figures = imported.report.figures;
  Json files = Json::array();
  for (const city::FileReport& file : imported.report.files) {
    files.push_back({{"file", file.file},
                     {"nodes", file.nodes},
                     {"ways", file.ways},
                     {"relations", file.relations},
                     {"problems", findings_json(file)}});
  }
  return {{"origin",
           {{"latitude_deg", city.origin.latitude_deg},
            {"longitude_deg", city.origin.longitude_deg},
            {"height_m", city.origin.height_m}}},
          {"south_west_m", {city.south_west_m.x(), city.south_west_m.y()}},
          {"north_east_m", {city.north_east_m.x(), city.north_east_m.y()}},
          {"buildings", buildings_json(figures)},
          {"streets", {{"count", figures.streets}, {"length_m", figures.street_length_m}}},
          {"trees", figures.trees},
          {"woods", figures.woods},
          {"terrain", city.terrain.has_value()},
          {"remarks", imported.report.remarks},
          {"files", std::move(files)}};
}

}  // namespace cuscus::orchestrator
