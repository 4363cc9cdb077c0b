// Any bytes as a map, and maps of all kinds of wrong objects: read, built, and looked at. The first
// octet says as what: XML, PBF, the inside of a PBF block, or a recipe for objects.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "common/city/import/build_city.h"
#include "common/city/import/footprints.h"
#include "common/city/import/read_osm.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/osm_text.h"

namespace {

using namespace cuscus;        // NOLINT(google-build-using-namespace): a main
using namespace cuscus::city;  // NOLINT(google-build-using-namespace): a main

/// Octets to be decided by; zeros after the last.
class Choices {
 public:
  explicit Choices(std::string_view octets) : octets_{octets} {}

  [[nodiscard]] bool left() const { return !octets_.empty(); }
  std::size_t below(std::size_t bound) {
    const auto octet = left() ? static_cast<unsigned char>(octets_.front()) : 0U;
    octets_.remove_prefix(left() ? 1 : 0);
    return octet % bound;
  }

 private:
  std::string_view octets_;
};

OsmText::TagList any_tags(Choices& choices) {
  static const std::array<std::string, 18> kKeys{"building",
                                                 "building:part",
                                                 "building",
                                                 "building:part",
                                                 "height",
                                                 "building:levels",
                                                 "min_height",
                                                 "natural",
                                                 "landuse",
                                                 "highway",
                                                 "building:material",
                                                 "name",
                                                 "width",
                                                 "lanes",
                                                 "roof:height",
                                                 "layer",
                                                 "location",
                                                 "building:min_level"};
  static const std::array<std::string, 18> kValues{
      "yes",    "yes", "12",    "3 storeys", "-5",      "1e9", "12'6\"", "roof",        "wood",
      "forest", "20",  "brick", "nan",       "primary", "0.5", "",       "underground", "-1"};
  OsmText::TagList tags{{choices.below(3) != 0 ? "building" : "building:part", "yes"}};
  for (std::size_t count = choices.below(4); count > 0; --count) {
    tags.emplace_back(kKeys.at(choices.below(kKeys.size())),
                      kValues.at(choices.below(kValues.size())));
  }
  return tags;
}

std::string any_map(Choices choices) {
  OsmText osm;
  constexpr std::size_t kNodes = 24;
  constexpr std::size_t kSide = 8;
  for (std::size_t i = 0; i < kNodes; ++i) {
    // Few places, so that nodes meet and lines cross.
    osm.node(static_cast<std::int64_t>(i), static_cast<double>(choices.below(kSide)) * 1e-4,
             static_cast<double>(choices.below(kSide)) * 1e-4);
  }
  std::int64_t ways = 0;
  while (choices.left() && ways < 12) {
    if (choices.below(8) == 0) {
      std::vector<OsmText::Member> members;
      for (std::size_t count = choices.below(4); count > 0; --count) {
        members.push_back({static_cast<std::int64_t>(choices.below(12)),
                           choices.below(2) != 0 ? "inner" : "outer"});
      }
      auto tags = any_tags(choices);
      tags.emplace_back("type", "multipolygon");
      osm.relation(static_cast<std::int64_t>(choices.below(4)), members, tags);
      continue;
    }
    std::vector<std::int64_t> nodes;
    for (std::size_t count = choices.below(10); count > 0; --count) {
      nodes.push_back(static_cast<std::int64_t>(choices.below(kNodes + 1)));
    }
    if (!nodes.empty() && choices.below(8) != 0) {
      nodes.push_back(nodes.front());
    }
    osm.way(ways++, nodes, any_tags(choices));
  }
  return osm.text();
}

void append_varint(std::string& to, std::size_t value) {
  for (; value >= 0x80U; value >>= 7U) {
    to += static_cast<char>((value & 0x7fU) | 0x80U);
  }
  to += static_cast<char>(value);
}

/// A field of the wire type "length-delimited".
void append_field(std::string& to, unsigned number, std::string_view content) {
  append_varint(to, number << 3U | 2U);
  append_varint(to, content.size());
  to += content;
}

std::string pbf_block(std::string_view type, std::string_view content) {
  std::string blob;
  append_field(blob, 1, content);  // raw
  std::string header;
  append_field(header, 1, type);
  append_varint(header, 3U << 3U);  // datasize, a varint
  append_varint(header, blob.size());
  std::string block(4, '\0');
  block[3] = static_cast<char>(header.size());  // big-endian, and below 128
  return block + header + blob;
}

std::string pbf_of(std::string_view block) {
  std::string header;
  append_field(header, 4, "OsmSchema-V0.6");
  append_field(header, 4, "DenseNodes");
  return pbf_block("OSMHeader", header) + pbf_block("OSMData", block);
}

/// Corners of cut pieces are rounded to 0.1 mm.
constexpr double kSliver_m = 2e-4;

void check(const City& city) {
  for (const Building& building : city.buildings) {
    must(!building.prisms.empty(), "a building has no prisms");
    for (const Prism& prism : building.prisms) {
      must(prism.bottom_m >= 0.0 && prism.bottom_m < prism.top_m && prism.top_m <= 2000.0,
           "a prism has no height");
      must(prism.footprint.outer.size() >= 3 && signed_area_m2(prism.footprint.outer) > 0.0,
           "a footprint has no area, or is clockwise");
      for (const Ring& courtyard : prism.footprint.courtyards) {
        must(signed_area_m2(courtyard) < 0.0, "a courtyard is counter-clockwise");
      }
      const double edge_m = 2.0 * area_m2(prism.footprint) / mean_width_m(prism.footprint);
      for (const Prism& other : building.prisms) {
        const bool beside =
            &other == &prism || other.bottom_m >= prism.top_m || other.top_m <= prism.bottom_m;
        must(beside || overlap_m2(prism.footprint, other.footprint) < kSliver_m * edge_m,
             "two prisms share volume");
      }
    }
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view rest{reinterpret_cast<const char*>(data) + 1, size - 1};
  const unsigned kind = data[0] % 4U;
  const std::string content = kind == 3   ? any_map(Choices{rest})
                              : kind == 2 ? pbf_of(rest)
                                          : std::string{rest};
  const OsmFormat format = kind == 0 || kind == 3 ? OsmFormat::kXml : OsmFormat::kPbf;
  ImportReport report;
  report.files.resize(1);
  try {
    OsmRecords records = read_osm(content, format, {.bounds = {}, .limits = {}}, report.files[0]);
    check(build_city(std::move(records), {}, report));
  } catch (const CityFileError&) {
    // Said so: that is what is asked.
  }
  return 0;
}
