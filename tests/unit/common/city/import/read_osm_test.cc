#include "common/city/import/read_osm.h"

#include <bzlib.h>
#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/osm_text.h"
#include "tests/support/temporary_folder.h"

namespace cuscus::city {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;

OsmRecords read_text(const OsmText& osm, FileReport& report, const ReadOptions& options = {}) {
  const std::string text = osm.text();
  return read_osm(text, OsmFormat::kXml, options, report);
}

fs::path written(const fs::path& file, const std::string& content) {
  std::ofstream{file, std::ios::binary} << content;
  return file;
}

std::string content_of(const fs::path& file) {
  std::ifstream stream{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

std::string bzip2_of(const std::string& text) {
  std::string packed(text.size() + 1000, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  std::string source = text;  // which the library takes as not const
  REQUIRE(BZ2_bzBuffToBuffCompress(packed.data(), &size, source.data(),
                                   static_cast<unsigned int>(source.size()), 9, 0, 0) == BZ_OK);
  packed.resize(size);
  return packed;
}

void write_gzip(const fs::path& file, const std::string& text) {
  const gzFile stream = gzopen(file.c_str(), "wb");
  REQUIRE(stream != nullptr);
  REQUIRE(gzwrite(stream, text.data(), static_cast<unsigned>(text.size())) > 0);
  REQUIRE(gzclose(stream) == Z_OK);
}

OsmText two_houses() {
  return OsmText{}
      .box(1, 0, 0, 1, 1, {{"building", "yes"}, {"height", "12"}})
      .box(2, 3, 0, 4, 1, {{"building", "yes"}});
}

/// The cause of the refusal to read the file.
std::string refusal(const fs::path& file, const ReadOptions& options = {}) {
  FileReport report;
  try {
    static_cast<void>(read_osm(file, options, report));
  } catch (const CityFileError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("buildings, parts, woods, streets and trees are read, and nothing else") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, {{"building", "yes"}, {"name", "Hall"}, {"addr:city", "X"}})
      .box(2, 0, 0, 1, 1, {{"building:part", "yes"}})
      .box(3, 5, 5, 9, 9, {{"natural", "wood"}})
      .box(4, 5, 5, 9, 9, {{"landuse", "forest"}})
      .box(5, 5, 5, 9, 9, {{"landuse", "meadow"}})
      .box(6, 5, 5, 9, 9, {{"building", "no"}})
      .way(7, {10, 12}, {{"highway", "residential"}})
      .node(100, 0.5, 0.25, {{"natural", "tree"}})
      .node(101, 0.5, 0.25, {{"natural", "peak"}});
  FileReport report;

  const OsmRecords records = read_text(osm, report);

  REQUIRE(records.areas.size() == 4);
  CHECK(records.areas[0].kind == AreaKind::kBuilding);
  CHECK(records.areas[0].object == ObjectId{ObjectType::kWay, 1});
  CHECK(records.areas[0].tags["name"] == "Hall");
  CHECK(records.areas[0].tags["addr:city"].empty());
  CHECK(records.areas[0].polygons.at(0).outer.size() == 4);
  CHECK(records.areas[1].kind == AreaKind::kPart);
  CHECK(records.areas[2].kind == AreaKind::kWood);
  CHECK(records.areas[3].kind == AreaKind::kWood);
  REQUIRE(records.streets.size() == 1);
  CHECK(records.streets[0].points.size() == 2);
  REQUIRE(records.trees.size() == 1);
  CHECK(records.trees[0].point.longitude_deg == Approx(0.5));
  CHECK(report.nodes == 26);
  CHECK(report.ways == 7);
}

TEST_CASE("a relation's inner ways are courtyards, and its outer way is no second building") {
  OsmText osm;
  osm.box(1, 0, 0, 10, 10, {{"building", "yes"}})  // tagged as its relation is
      .box(2, 4, 4, 6, 6, {})
      .box(3, 1, 1, 2, 2, {{"building", "kiosk"}})  // in a courtyard of its own
      .relation(7, {{1, "outer"}, {2, "inner"}, {3, "inner"}},
                {{"type", "multipolygon"}, {"building", "palace"}});
  FileReport report;

  const OsmRecords records = read_text(osm, report);

  REQUIRE(records.areas.size() == 2);
  CHECK(records.areas[0].object == ObjectId{ObjectType::kRelation, 7});
  REQUIRE(records.areas[0].polygons.size() == 1);
  CHECK(records.areas[0].polygons[0].courtyards.size() == 2);
  CHECK(records.areas[1].object == ObjectId{ObjectType::kWay, 3});
  CHECK(report.of(Problem::kDuplicate).count == 1);
}

TEST_CASE("outlines that enclose nothing are reported, each with its cause") {
  OsmText osm;
  osm.node(1, 0.0, 0.0).node(2, 0.001, 0.0).node(3, 0.001, 0.001).node(4, 0.0, 0.001);
  osm.way(1, {1, 2, 3, 4}, {{"building", "yes"}})      // open
      .way(2, {1, 3, 2, 4, 1}, {{"building", "yes"}})  // a bow tie
      .way(3, {1, 2, 1}, {{"building", "yes"}})        // two corners
      .way(4, {1, 2, 99, 1}, {{"building", "yes"}})    // a node that is not there
      .way(5, {1, 2, 3, 1}, {{"building", "yes"}})     // a good one
      .way(6, {1, 2, 1, 2, 1}, {{"building", "yes"}})  // there and back
      .relation(7, {{5, "outer"}, {99, "inner"}}, {{"type", "multipolygon"}, {"building", "yes"}})
      .relation(8, {{1, "outer"}}, {{"type", "multipolygon"}, {"building", "yes"}});
  FileReport report;

  const OsmRecords records = read_text(osm, report);

  REQUIRE(records.areas.size() == 1);
  CHECK(records.areas[0].object.id == 5);
  CHECK(report.of(Problem::kOpenRing).count == 2);
  CHECK(report.of(Problem::kOpenRing).examples.at(0).object == ObjectId{ObjectType::kRelation, 8});
  CHECK(report.of(Problem::kOpenRing).examples.at(1).object == ObjectId{ObjectType::kWay, 1});
  CHECK(report.of(Problem::kCrossesItself).examples.at(0).object.id == 2);
  CHECK(report.of(Problem::kTooFewPoints).examples.at(0).object.id == 3);
  CHECK(report.of(Problem::kMissingNodes).examples.at(0).object.id == 4);
  CHECK(report.of(Problem::kNoArea).examples.at(0).object.id == 6);
  CHECK(report.of(Problem::kMissingMembers).examples.at(0).object.id == 7);
}

TEST_CASE("the order of objects in a file has no effect, and the second of one id is dropped") {
  OsmText osm;
  osm.relation(7, {{1, "outer"}}, {{"type", "multipolygon"}, {"building", "yes"}})
      .way(2, {4, 3, 2, 4}, {{"building", "yes"}})
      .way(2, {4, 3, 1, 4}, {{"building", "yes"}})
      .way(1, {1, 2, 3, 1}, {})
      .node(4, 0.0, 0.001)
      .node(3, 0.001, 0.001)
      .node(2, 0.001, 0.0)
      .node(1, 0.0, 0.0)
      .node(-5, 0.0, 0.0);
  FileReport report;

  const OsmRecords records = read_text(osm, report);

  REQUIRE(records.areas.size() == 2);
  CHECK(records.areas[0].object == ObjectId{ObjectType::kRelation, 7});
  CHECK(records.areas[1].object == ObjectId{ObjectType::kWay, 2});
  CHECK(report.of(Problem::kDuplicate).count == 1);
  CHECK(report.nodes == 5);
}

TEST_CASE("what does not meet the bounding box is left out, what meets it stays whole") {
  OsmText osm = two_houses();
  osm.way(9, {10, 11}, {{"highway", "service"}})
      .way(10, {20, 21}, {{"highway", "service"}})
      .node(200, 0.0002, 0.0, {{"natural", "tree"}})
      .node(201, 0.0004, 0.0, {{"natural", "tree"}});
  FileReport report;

  const OsmRecords records =
      read_text(osm, report, {.bounds = GeoBox{0.00005, 0.0, 0.00025, 0.001}, .limits = {}});

  REQUIRE(records.areas.size() == 1);
  CHECK(records.areas[0].object.id == 1);
  CHECK(records.areas[0].polygons[0].outer.size() == 4);
  REQUIRE(records.streets.size() == 1);
  CHECK(records.streets[0].object.id == 9);
  REQUIRE(records.trees.size() == 1);
  CHECK(records.trees[0].object.id == 200);
}

TEST_CASE("a street is in pieces where nodes are missing") {
  OsmText osm;
  osm.node(1, 0.0, 0.0).node(2, 0.1, 0.0).node(4, 0.3, 0.0).node(5, 0.4, 0.0).node(7, 0.6, 0.0);
  osm.way(1, {1, 2, 3, 4, 5, 6, 7}, {{"highway", "primary"}});
  FileReport report;

  const OsmRecords records = read_text(osm, report);

  REQUIRE(records.streets.size() == 2);
  CHECK(records.streets[0].points.size() == 2);
  CHECK(records.streets[1].points[0].longitude_deg == Approx(0.3));
}

TEST_CASE("plain, gzip, bzip2 and PBF files hold the same city") {
  const TemporaryFolder folder;
  const std::string text = two_houses().text();
  std::vector<fs::path> files{written(folder.path() / "a.osm", text), folder.path() / "a.osm.gz",
                              written(folder.path() / "a.osm.bz2", bzip2_of(text))};
  write_gzip(files[1], text);
  if (std::system("command -v osmium >/dev/null") == 0) {
    files.push_back(folder.path() / "a.osm.pbf");
    // Sorted, as osmium wants it.
    const std::string command =
        "osmium sort --no-progress -o " + files.back().native() + " " + files[0].native();
    REQUIRE(std::system(command.c_str()) == 0);
  } else {
    WARN("SKIPPED: PBF needs osmium (Debian: osmium-tool)");
  }

  for (const fs::path& file : files) {
    CAPTURE(file);
    FileReport report;
    const OsmRecords records = read_osm(file, {}, report);
    REQUIRE(records.areas.size() == 2);
    CHECK(records.areas[0].tags["height"] == "12");
    CHECK(records.areas[1].polygons[0].outer[0].longitude_deg == Approx(3e-4));
    CHECK(report.file == file);
    CHECK(report.nodes == 8);
  }
}

TEST_CASE("a file that is none is refused before it is read") {
  const TemporaryFolder folder;
  const fs::path& in = folder.path();
  fs::create_directory(in / "folder.osm");
  fs::resize_file(written(in / "huge.osm.pbf", "x"), 10'000'000'000);  // sparse: takes no space

  CHECK_THAT(refusal(in / "nothing.osm"), Contains("nothing.osm: ") && Contains("No such file"));
  CHECK_THAT(refusal(in / "folder.osm"), Contains("folder.osm: is a directory"));
  CHECK_THAT(refusal("/dev/null"), Contains("allowed: names that end in .osm, .osm.gz"));
  CHECK_THAT(refusal(written(in / "empty.osm", "")), Contains("empty.osm: is empty"));
  CHECK_THAT(refusal(in / "huge.osm.pbf"), Contains("has 10000 MB; allowed: up to 2000 MB"));
  CHECK_THAT(refusal("http://localhost/x.osm"), Contains("No such file"));
  CHECK_THAT(refusal("-"), Contains("allowed: names that end in"));
}

TEST_CASE("a file that is not what its name says is refused with the cause") {
  const TemporaryFolder folder;
  const fs::path& in = folder.path();
  const std::string text = two_houses().text();

  for (const char* name : {"noise.osm", "noise.osm.gz", "noise.osm.bz2", "noise.osm.pbf"}) {
    CHECK_THAT(refusal(written(in / name, "This is no map. " + std::string(100, '\x07'))),
               Contains(std::string{name} + ": is no whole OpenStreetMap file: "));
  }
  CHECK_THAT(refusal(written(in / "page.osm", "<html><body>429</body></html>")),
             Contains("Unknown top-level element: html"));
  CHECK_THAT(refusal(written(in / "xml.osm.pbf", text)),
             Contains("is no whole OpenStreetMap file"));
  CHECK_THAT(refusal(written(in / "id.osm", "<osm version='0.6'><node id='x'/></osm>")),
             Contains("is no whole OpenStreetMap file"));
}

TEST_CASE("a truncated file is refused, wherever it ends") {
  const TemporaryFolder folder;
  const std::string text = two_houses().text();
  write_gzip(folder.path() / "whole.osm.gz", text);
  const std::string gzip = content_of(folder.path() / "whole.osm.gz");
  const std::string bzip2 = bzip2_of(text);

  for (std::size_t tenth = 1; tenth < 10; ++tenth) {
    CAPTURE(tenth);
    const auto cut = [&](const char* name, const std::string& whole) {
      return refusal(written(folder.path() / name, whole.substr(0, whole.size() * tenth / 10)));
    };
    CHECK_THAT(cut("cut.osm", text), Contains("cut.osm: is no whole OpenStreetMap file"));
    CHECK_THAT(cut("cut.osm.gz", gzip), Contains("cut.osm.gz: is no whole OpenStreetMap file"));
    CHECK_THAT(cut("cut.osm.bz2", bzip2), Contains("cut.osm.bz2: is no whole OpenStreetMap file"));
  }
}

TEST_CASE("entities are refused, before they grow") {
  const TemporaryFolder folder;
  std::string bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE osm [<!ENTITY a0 \"lol\">";
  for (int i = 1; i < 30; ++i) {
    const std::string inner = "&a" + std::to_string(i - 1) + ";";
    bomb += "<!ENTITY a" + std::to_string(i) + " \"" + inner + inner + inner + inner + "\">";
  }
  bomb +=
      "]>\n<osm version=\"0.6\"><node id=\"1\" lat=\"0\" lon=\"0\"><tag k=\"name\" "
      "v=\"&a29;\"/></node></osm>";

  CHECK_THAT(refusal(written(folder.path() / "bomb.osm", bomb)),
             Contains("bomb.osm: ") && Contains("XML entities are not supported"));
}

TEST_CASE("a file that holds more than the limit is refused while it is read") {
  const TemporaryFolder folder;
  const fs::path file = written(folder.path() / "large.osm", two_houses().text());

  CHECK_THAT(refusal(file, {.bounds = {}, .limits = {.kept_bytes = 100}}),
             Contains("large.osm: holds more than") && Contains("osmium extract"));
}

TEST_CASE("places that are not on earth are no places") {
  OsmText osm = two_houses();
  osm.node(1000, 200.0, 95.0, {{"natural", "tree"}})
      .way(11, {10, 11, 1000, 10}, {{"building", "yes"}});
  FileReport report;

  const OsmRecords records = read_text(osm, report);

  CHECK(records.areas.size() == 2);
  CHECK(records.trees.empty());
  CHECK(report.of(Problem::kMissingNodes).count == 1);
  REQUIRE(records.extent);
  CHECK(records.extent->east_deg == Approx(4e-4));
}

TEST_CASE("examples are few, and no mapper's text reaches a terminal's controls") {
  FileReport report;
  for (int i = 0; i < 100; ++i) {
    report.add(Problem::kBadHeight, {ObjectType::kWay, i},
               "height=\x1b[31m" + std::string(500, 'x'));
  }

  const Finding& finding = report.of(Problem::kBadHeight);
  CHECK(finding.count == 100);
  REQUIRE(finding.examples.size() == Finding::kMaxExamples);
  CHECK(finding.examples[0].detail.size() == 80);
  CHECK(finding.examples[0].detail.starts_with("height=?[31m"));
  CHECK(text_of(finding.examples[0].object) == "way 0");
}

}  // namespace
}  // namespace cuscus::city
