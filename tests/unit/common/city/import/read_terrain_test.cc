#include "common/city/import/read_terrain.h"

#include <catch2/catch.hpp>
#include <sstream>

namespace cuscus::city {
namespace {

using Catch::Contains;

AsciiGrid grid_of(const std::string& text) {
  std::istringstream stream{text};
  return read_ascii_grid(stream, "hill.asc");
}

std::string grid_refusal(const std::string& text) {
  try {
    static_cast<void>(grid_of(text));
  } catch (const CityFileError& error) {
    return error.what();
  }
  return "none";
}

const std::string kHead = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n";

TEST_CASE("a grid has its northern row first, and its values at the cells' centres") {
  const AsciiGrid grid = grid_of(kHead + "NODATA_value -9999\n1 2 3\n4 5 6\n");

  CHECK(grid.columns == 3);
  CHECK(grid.rows == 2);
  CHECK(grid.at(105, 205) == Approx(4.0));
  CHECK(grid.at(125, 215) == Approx(3.0));
  CHECK(grid.at(110, 210) == Approx((1.0 + 2.0 + 4.0 + 5.0) / 4.0));
  CHECK(grid.at(0, 0) == Approx(4.0));  // beyond, as at the edge
  CHECK(grid.covers(100, 200));
  CHECK_FALSE(grid.covers(99, 200));
}

TEST_CASE("a grid may give the first cell's centre, and keys in any case") {
  const AsciiGrid grid = grid_of("NCOLS 1\nNROWS 1\nXLLCENTER 7\nYLLCENTER 8\nCELLSIZE 2\n42.5\n");

  CHECK(grid.west == 7.0);
  CHECK(grid.south == 8.0);
  CHECK(grid.at(100, -100) == Approx(42.5));
}

TEST_CASE("cells without a height have the lowest of all, and are counted") {
  const AsciiGrid grid = grid_of(kHead + "nodata_value -9999\n1 2 -9999\n4 5 6\n");

  CHECK(grid.holes == 1);
  CHECK(grid.at(125, 215) == Approx(1.0));
}

TEST_CASE("what is no grid is refused with the place of the fault") {
  CHECK_THAT(grid_refusal(""), Contains("hill.asc: is no ESRI ASCII grid: ncols is missing"));
  CHECK_THAT(grid_refusal("ncols 3\nnrows 2\n1 2 3 4 5 6"), Contains("cellsize is missing"));
  CHECK_THAT(grid_refusal(kHead + "1 2 3\n4 5\n"), Contains("row 2 of 2, column 3 is missing"));
  CHECK_THAT(grid_refusal(kHead + "1 2 x\n4 5 6\n"), Contains("row 1 of 2, column 3"));
  CHECK_THAT(grid_refusal(kHead + "1 2 1e30\n4 5 6\n"), Contains("not on earth"));
  CHECK_THAT(grid_refusal("ncols many\n"), Contains("\"ncols\" is not followed by a number"));
  CHECK_THAT(grid_refusal("ncols 0\nnrows 2\n"), Contains("ncols is no whole number from 1"));
  CHECK_THAT(grid_refusal("ncols 2.5\nnrows 2\n"), Contains("ncols is no whole number from 1"));
  CHECK_THAT(
      grid_refusal("ncols 20000000\nnrows 20000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1"),
      Contains("more than 25000000 cells"));
  CHECK_THAT(grid_refusal("ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize -1\n1"),
             Contains("cellsize is not above 0"));
  CHECK_THAT(
      grid_refusal("ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value 1\n1"),
      Contains("no cell has a height"));
}

TEST_CASE("ground in local metres is the grid's, less its height at the origin") {
  // A slope of 1 in 10 to the east through 50 m at the origin.
  const AsciiGrid grid = grid_of(
      "ncols 3\nnrows 2\nxllcenter -100\nyllcenter -50\ncellsize 100\n40 50 60\n40 50 60\n");
  const LocalFrame frame{{.latitude_deg = 44.5, .longitude_deg = 11.3}};

  const PlacedTerrain ground =
      ground_of(grid, TerrainFrame::kLocal, frame,
                Eigen::AlignedBox2d{Eigen::Vector2d{-80, -40}, Eigen::Vector2d{80, 40}});

  CHECK(height_at_origin(grid, TerrainFrame::kLocal, frame.origin()) == Approx(50.0));
  CHECK(ground.covered);
  CHECK(height_at(ground.terrain, {0, 0}) == Approx(0.0).margin(1e-5));
  CHECK(height_at(ground.terrain, {20, 10}) == Approx(2.0));
  CHECK(height_at(ground.terrain, {-80, 0}) == Approx(-8.0));
}

TEST_CASE("ground in degrees rises where its place on the map is") {
  // 1 m per 0.001 degree of longitude; a degree of longitude has 79.5 km at 44.5 degrees north.
  std::string rows;
  for (int r = 0; r < 11; ++r) {
    for (int c = 0; c < 11; ++c) {
      rows += std::to_string(c) + " ";
    }
    rows += "\n";
  }
  const AsciiGrid grid =
      grid_of("ncols 11\nnrows 11\nxllcenter 11.295\nyllcenter 44.495\ncellsize 0.001\n" + rows);
  const LocalFrame frame{{.latitude_deg = 44.5, .longitude_deg = 11.3}};

  const PlacedTerrain ground =
      ground_of(grid, TerrainFrame::kGeographic, frame,
                Eigen::AlignedBox2d{Eigen::Vector2d{-300, -300}, Eigen::Vector2d{300, 300}});

  CHECK(height_at_origin(grid, TerrainFrame::kGeographic, frame.origin()) == Approx(5.0));
  const Eigen::Vector3d east = frame.to_local({.latitude_deg = 44.5, .longitude_deg = 11.303});
  CHECK(east.x() == Approx(238.5).epsilon(0.01));
  CHECK(height_at(ground.terrain, east.head<2>()) == Approx(3.0).epsilon(1e-3));
  CHECK(ground.covered);
}

}  // namespace
}  // namespace cuscus::city
