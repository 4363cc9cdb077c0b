// Cities that are made up, through the importer of real ones.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "common/city/generate/generate.h"
#include "common/city/import/import_city.h"
#include "tests/support/temporary_folder.h"

namespace cuscus::city::generate {
namespace {

ImportedCity imported(const Request& request) {
  const TemporaryFolder folder;
  const std::array<std::filesystem::path, 1> files{folder.path() / "made.osm"};
  std::ofstream{files[0]} << make_osm(request);
  ImportOptions options;
  options.origin = default_origin(request.style);
  return import_city(files, options);
}

double area_m2(const Ring& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto& a = ring[i];
    const auto& b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return std::abs(twice / 2.0);
}

double area_m2(const Footprint& footprint) {
  double sum = area_m2(footprint.outer);
  for (const Ring& courtyard : footprint.courtyards) {
    sum -= area_m2(courtyard);
  }
  return sum;
}

double volume_m3(const PlannedBuilding& building) {
  double sum = building.parts.empty() ? area_m2(building.footprint) * building.height_m : 0.0;
  for (const Prism& part : building.parts) {
    sum += area_m2(part.footprint) * (part.top_m - part.bottom_m);
  }
  return sum;
}

double volume_m3(const Building& building) {
  double sum = 0.0;
  for (const Prism& prism : building.prisms) {
    sum += area_m2(prism.footprint) * (prism.top_m - prism.bottom_m);
  }
  return sum;
}

double highest_m(const Building& building) {
  double top_m = 0.0;
  for (const Prism& prism : building.prisms) {
    top_m = std::max(top_m, prism.top_m);
  }
  return top_m;
}

}  // namespace

TEST_CASE("A made-up city comes through the importer as it was planned, without a complaint") {
  const Style style = GENERATE(Style::kOldTown, Style::kGrid);
  const std::uint64_t seed = GENERATE(1U, 7U);
  CAPTURE(style == Style::kGrid, seed);
  const Request request{.style = style, .seed = seed, .size_m = 400.0};
  const Plan plan = make_plan(request);

  const ImportedCity made = imported(request);

  for (std::size_t problem = 0; problem < kProblems; ++problem) {
    CAPTURE(text_of(static_cast<Problem>(problem)).line);
    REQUIRE(made.report.files.at(0).of(static_cast<Problem>(problem)).count == 0);
  }
  REQUIRE(made.city.buildings.size() == plan.buildings.size());
  REQUIRE(made.city.streets.size() == plan.streets.size());
  REQUIRE(made.city.trees.size() == plan.trees.size());
  REQUIRE(made.city.woods.size() == plan.woods.size());
  double planned_m3 = 0.0;
  std::multiset<double> planned_heights_m;
  for (const PlannedBuilding& building : plan.buildings) {
    planned_m3 += volume_m3(building);
    planned_heights_m.insert(building.height_m);
  }
  double imported_m3 = 0.0;
  std::multiset<double> imported_heights_m;
  for (const Building& building : made.city.buildings) {
    imported_m3 += volume_m3(building);
    imported_heights_m.insert(highest_m(building));
  }
  // The reader keeps corners to 1 cm: of a house of 20 m, 0.1 % of its area at most, and the errors
  // of hundreds of corners cancel.
  REQUIRE(imported_m3 == Approx(planned_m3).epsilon(1e-4));
  REQUIRE(imported_heights_m == planned_heights_m);
}

TEST_CASE("A made-up city keeps its place: trees stand where they were planned, within 1 cm") {
  const Request request{.style = Style::kGrid, .seed = 3};
  const Plan plan = make_plan(request);

  const ImportedCity made = imported(request);

  REQUIRE(made.city.trees.size() == plan.trees.size());
  for (const Tree& tree : plan.trees) {
    // 1e-7 degrees are 11 mm north and 8 mm east: half of that is the rounding.
    REQUIRE(std::any_of(made.city.trees.begin(), made.city.trees.end(), [&](const Tree& other) {
      return (other.foot_m - tree.foot_m).head<2>().norm() < 0.008 &&
             other.height_m == Approx(tree.height_m);
    }));
  }
}

}  // namespace cuscus::city::generate
