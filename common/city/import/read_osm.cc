#include "common/city/import/read_osm.h"

#include <algorithm>
#include <array>
#include <osmium/io/bzip2_compression.hpp>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/xml_input.hpp>
#include <string>
#include <system_error>

#include "common/city/import/osm_objects.h"

namespace cuscus::city {
namespace {

namespace fs = std::filesystem;

struct FormatName {
  std::string_view ending;
  OsmFormat format;
  const char* osmium_name;
};
constexpr std::array<FormatName, 4> kFormats{{
    {".osm", OsmFormat::kXml, "osm"},
    {".osm.gz", OsmFormat::kXmlGzip, "osm.gz"},
    {".osm.bz2", OsmFormat::kXmlBzip2, "osm.bz2"},
    {".osm.pbf", OsmFormat::kPbf, "pbf"},
}};

const FormatName& format_of(const fs::path& file) {
  const std::string& name = file.native();
  const auto found = std::ranges::find_if(
      kFormats, [&](const FormatName& format) { return name.ends_with(format.ending); });
  if (found == kFormats.end()) {
    throw CityFileError{name +
                        ": is no OpenStreetMap file by its name; allowed: names that end in "
                        ".osm, .osm.gz, .osm.bz2 or .osm.pbf"};
  }
  return *found;
}

/// What can be known before anything is read.
void check_file(const fs::path& file, const ReadLimits& limits) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (error) {
    throw CityFileError{file.native() + ": " + error.message()};
  }
  if (!fs::is_regular_file(status)) {
    throw CityFileError{file.native() + ": is " +
                        (fs::is_directory(status) ? "a directory" : "no regular file")};
  }
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) {
    throw CityFileError{file.native() + ": " + error.message()};
  }
  if (bytes == 0) {
    throw CityFileError{file.native() + ": is empty"};
  }
  if (bytes > limits.file_bytes) {
    throw CityFileError{file.native() + ": has " + std::to_string(bytes / 1'000'000) +
                        " MB; allowed: up to " + std::to_string(limits.file_bytes / 1'000'000) +
                        " MB; cut it first, such as by: osmium extract --bbox W,S,E,N"};
  }
}

GeoBox box_of_area(const AreaRecord& area) {
  const GeoPoint& first = area.polygons.front().outer.front();
  GeoBox box{first.longitude_deg, first.latitude_deg, first.longitude_deg, first.latitude_deg};
  for (const GeoPolygon& polygon : area.polygons) {
    for (const GeoPoint& p : polygon.outer) {
      box.extend({p.longitude_deg, p.latitude_deg, p.longitude_deg, p.latitude_deg});
    }
  }
  return box;
}

/// The way in pieces between nodes that are not in the file, as those beyond an extract's edge.
void add_street(const osmium::Way& way, OsmRecords& records) {
  StreetRecord street;
  street.object = {ObjectType::kWay, way.id()};
  street.tags = known_tags(way.tags());
  const auto finish = [&] {
    if (street.points.size() >= 2) {
      records.streets.push_back(street);
    }
    street.points.clear();
  };
  for (const auto& node : way.nodes()) {
    if (node.location().valid()) {
      street.points.push_back({node.lon(), node.lat()});
    } else {
      finish();
    }
  }
  finish();
}

void add_tree(const osmium::Node& node, OsmRecords& records) {
  if (node.location().valid() && node.tags().has_tag("natural", "tree")) {
    records.trees.push_back({.object = {ObjectType::kNode, node.id()},
                             .point = {node.location().lon(), node.location().lat()},
                             .tags = known_tags(node.tags())});
  }
}

void crop(OsmRecords& records, const GeoBox& bounds) {
  std::erase_if(records.areas,
                [&](const AreaRecord& area) { return !bounds.meets(box_of_area(area)); });
  std::erase_if(records.trees,
                [&](const TreeRecord& tree) { return !bounds.contains(tree.point); });
  std::erase_if(records.streets, [&](const StreetRecord& street) {
    GeoBox box{street.points[0].longitude_deg, street.points[0].latitude_deg,
               street.points[0].longitude_deg, street.points[0].latitude_deg};
    for (const GeoPoint& p : street.points) {
      box.extend({p.longitude_deg, p.latitude_deg, p.longitude_deg, p.latitude_deg});
    }
    return !bounds.meets(box);
  });
}

OsmRecords read(const osmium::io::File& file, const ReadOptions& options, FileReport& report) {
  OsmObjects objects{options.limits.kept_bytes};
  OsmRecords records;
  osmium::io::Reader reader{file, osmium::osm_entity_bits::nwr, osmium::io::read_meta::no};
  while (const osmium::memory::Buffer buffer = reader.read()) {
    for (const auto& object : buffer.select<osmium::OSMObject>()) {
      objects.keep(object);
      if (object.type() == osmium::item_type::node) {
        add_tree(static_cast<const osmium::Node&>(object), records);
      }
    }
  }
  reader.close();
  objects.index(report);
  records.extent = objects.extent();
  records.areas = assemble_areas(objects, report);
  for (const osmium::Way* way : objects.ways()) {
    if (way->tags().has_key("highway")) {
      add_street(*way, records);
    }
  }
  if (options.bounds) {
    crop(records, *options.bounds);
  }
  const auto mark = [&](auto& of_kind) {
    for (auto& record : of_kind) {
      record.file = options.file;
    }
  };
  mark(records.areas);
  mark(records.streets);
  mark(records.trees);
  return records;
}

/// Reads, and says of whatever goes wrong in which file it was.
OsmRecords read_or_explain(const osmium::io::File& file, const ReadOptions& options,
                           FileReport& report) {
  try {
    return read(file, options, report);
  } catch (const TooManyObjects& error) {
    throw CityFileError{report.file + ": " + error.what()};
  } catch (const std::exception& error) {
    throw CityFileError{report.file + ": is no whole OpenStreetMap file: " + error.what()};
  }
}

}  // namespace

OsmRecords read_osm(const fs::path& file, const ReadOptions& options, FileReport& report) {
  const FormatName& format = format_of(file);
  check_file(file, options.limits);
  report.file = file.native();
  // An absolute path is nothing but a file; "http:..." and "-" mean something else to libosmium.
  return read_or_explain(osmium::io::File{fs::absolute(file).native(), format.osmium_name}, options,
                         report);
}

OsmRecords read_osm(std::string_view content, OsmFormat format, const ReadOptions& options,
                    FileReport& report) {
  const auto name = std::ranges::find(kFormats, format, &FormatName::format);
  return read_or_explain(osmium::io::File{content.data(), content.size(), name->osmium_name},
                         options, report);
}

}  // namespace cuscus::city
