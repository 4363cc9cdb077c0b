#include <algorithm>
#include <optional>
#include <osmium/area/assembler.hpp>
#include <osmium/area/problem_reporter.hpp>
#include <osmium/osm/area.hpp>
#include <set>
#include <string>
#include <string_view>

#include "common/city/import/osm_objects.h"

namespace cuscus::city {
namespace {

/// Why the assembler made no area of the last object.
class LastCause final : public osmium::area::ProblemReporter {
 public:
  /// The cause since the last call.
  [[nodiscard]] Problem take() {
    const Problem cause = cause_.value_or(Problem::kNoArea);
    cause_.reset();
    return cause;
  }

  void report_intersection(osmium::object_id_type /*way1*/, osmium::Location /*start1*/,
                           osmium::Location /*end1*/, osmium::object_id_type /*way2*/,
                           osmium::Location /*start2*/, osmium::Location /*end2*/,
                           osmium::Location /*intersection*/) override {
    note(Problem::kCrossesItself);
  }
  void report_ring_not_closed(const osmium::NodeRef& /*node*/,
                              const osmium::Way* /*way*/) override {
    note(Problem::kOpenRing);
  }
  void report_invalid_location(osmium::object_id_type /*way*/,
                               osmium::object_id_type /*node*/) override {
    note(Problem::kMissingNodes);
  }

 private:
  void note(Problem cause) { cause_ = cause_.value_or(cause); }

  std::optional<Problem> cause_;
};

bool is_set(const osmium::TagList& tags, const char* key) {
  const std::string_view value = tags.get_value_by_key(key, "no");
  return value != "no";
}

std::optional<AreaKind> kind_of(const osmium::TagList& tags) {
  if (is_set(tags, "building")) {
    return AreaKind::kBuilding;
  }
  if (is_set(tags, "building:part")) {
    return AreaKind::kPart;
  }
  if (tags.has_tag("natural", "wood") || tags.has_tag("landuse", "forest")) {
    return AreaKind::kWood;
  }
  return std::nullopt;
}

GeoRing ring_of(const osmium::NodeRefList& nodes) {
  GeoRing ring;
  ring.reserve(nodes.size());
  for (const auto& node : nodes) {
    ring.push_back({node.lon(), node.lat()});
  }
  ring.pop_back();  // which is the first again
  return ring;
}

std::vector<GeoPolygon> polygons_of(const osmium::Area& area) {
  std::vector<GeoPolygon> polygons;
  for (const auto& outer : area.outer_rings()) {
    GeoPolygon& polygon = polygons.emplace_back();
    polygon.outer = ring_of(outer);
    for (const auto& inner : area.inner_rings(outer)) {
      polygon.courtyards.push_back(ring_of(inner));
    }
  }
  return polygons;
}

class AreaAssembly {
 public:
  AreaAssembly(const OsmObjects& objects, FileReport& report) : objects_{objects}, report_{report} {
    config_.problem_reporter = &cause_;
    config_.create_empty_areas = false;
  }

  void add(const osmium::Relation& relation) {
    const auto kind = kind_of(relation.tags());
    if (!kind || !relation.tags().has_tag("type", "multipolygon")) {
      return;
    }
    const ObjectId object{ObjectType::kRelation, relation.id()};
    std::vector<const osmium::Way*> members;
    for (const auto& member : relation.members()) {
      if (member.type() != osmium::item_type::way) {
        continue;
      }
      members.push_back(objects_.way(member.ref()));
      if (members.back() == nullptr) {
        report_.add(Problem::kMissingMembers, object, "way " + std::to_string(member.ref()));
        return;
      }
    }
    osmium::area::Assembler assembler{config_};
    if (!take(assembler(relation, members, buffer_), *kind, object)) {
      return;
    }
    for (const auto& member : relation.members()) {
      if (member.type() == osmium::item_type::way && std::string_view{member.role()} != "inner") {
        outlines_.emplace(*kind, member.ref());
      }
    }
  }

  /// After all relations.
  void add(const osmium::Way& way) {
    const auto kind = kind_of(way.tags());
    if (!kind || way.tags().has_tag("area", "no")) {
      return;
    }
    const ObjectId object{ObjectType::kWay, way.id()};
    if (outlines_.contains({*kind, way.id()})) {
      // Tagged as its relation is: one building, mapped twice.
      report_.add(Problem::kDuplicate, object, "outline of a relation that is a building or wood");
      return;
    }
    if (const auto problem = problem_of(way)) {
      report_.add(*problem, object);
      return;
    }
    osmium::area::Assembler assembler{config_};
    take(assembler(way, buffer_), *kind, object);
  }

  [[nodiscard]] std::vector<AreaRecord> records() && { return std::move(records_); }

 private:
  /// What the assembler would not say.
  static std::optional<Problem> problem_of(const osmium::Way& way) {
    const auto& nodes = way.nodes();
    if (std::ranges::any_of(nodes, [](const auto& node) { return !node.location().valid(); })) {
      return Problem::kMissingNodes;
    }
    if (nodes.size() < 2 || nodes.front().location() != nodes.back().location()) {
      return Problem::kOpenRing;
    }
    constexpr std::size_t kTriangle = 4;  // its first corner is its last again
    if (nodes.size() < kTriangle) {
      return Problem::kTooFewPoints;
    }
    return std::nullopt;
  }

  bool take(bool assembled, AreaKind kind, const ObjectId& object) {
    const Problem cause = cause_.take();
    if (!assembled || buffer_.committed() == 0) {
      report_.add(cause, object);
      buffer_.clear();
      return false;
    }
    const auto& area = buffer_.get<osmium::Area>(0);
    records_.push_back({.object = object,
                        .kind = kind,
                        .polygons = polygons_of(area),
                        .tags = known_tags(area.tags())});
    buffer_.clear();
    return true;
  }

  const OsmObjects& objects_;
  FileReport& report_;
  LastCause cause_;
  osmium::area::AssemblerConfig config_;
  osmium::memory::Buffer buffer_{1UL << 16U, osmium::memory::Buffer::auto_grow::yes};
  std::set<std::pair<AreaKind, std::int64_t>> outlines_;
  std::vector<AreaRecord> records_;
};

}  // namespace

std::vector<AreaRecord> assemble_areas(const OsmObjects& objects, FileReport& report) {
  AreaAssembly assembly{objects, report};
  for (const osmium::Relation* relation : objects.relations()) {
    assembly.add(*relation);
  }
  for (const osmium::Way* way : objects.ways()) {
    assembly.add(*way);
  }
  return std::move(assembly).records();
}

}  // namespace cuscus::city
