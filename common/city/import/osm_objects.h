#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/location.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/object.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/city/import/import_report.h"
#include "common/city/import/osm_records.h"

namespace cuscus::city {

/// The file holds more than the importer keeps in memory.
struct TooManyObjects : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The nodes, ways and relations of one file, in whatever order they came.
class OsmObjects {
 public:
  explicit OsmObjects(std::size_t limit_bytes) : limit_bytes_{limit_bytes} {}

  /// @throws TooManyObjects
  void keep(const osmium::OSMObject& object);

  /// To be called once, when all objects are kept: drops the second of two objects with one id, and
  /// gives ways the places of their nodes (undefined where a node is missing).
  void index(FileReport& report);

  /// By rising id.
  [[nodiscard]] const std::vector<const osmium::Way*>& ways() const { return ways_; }
  [[nodiscard]] const std::vector<const osmium::Relation*>& relations() const { return relations_; }
  /// Null: not in the file.
  [[nodiscard]] const osmium::Way* way(std::int64_t id) const;
  [[nodiscard]] const std::optional<GeoBox>& extent() const { return extent_; }

 private:
  void charge(std::size_t bytes);
  void sort_nodes(FileReport& report);
  [[nodiscard]] osmium::Location location_of(std::int64_t id) const;

  std::size_t limit_bytes_;
  std::size_t kept_bytes_{0};
  std::vector<std::pair<std::int64_t, osmium::Location>> nodes_;
  osmium::memory::Buffer buffer_{1UL << 20U, osmium::memory::Buffer::auto_grow::yes};
  std::vector<const osmium::Way*> ways_;
  std::vector<const osmium::Relation*> relations_;
  std::optional<GeoBox> extent_;
};

/// The tags of an object that the importer knows.
[[nodiscard]] Tags known_tags(const osmium::TagList& tags);

/// Buildings, parts and woods: libosmium's multipolygon assembler on closed ways and relations.
[[nodiscard]] std::vector<AreaRecord> assemble_areas(const OsmObjects& objects, FileReport& report);

}  // namespace cuscus::city
