#include "common/city/import/osm_objects.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace cuscus::city {
namespace {

ObjectId id_of(const osmium::OSMObject& object) {
  const auto type =
      object.type() == osmium::item_type::way ? ObjectType::kWay : ObjectType::kRelation;
  return {type, object.id()};
}

/// Sorts by id and drops all but the first of those with one id.
template <typename Object>
void sort_unique(std::vector<const Object*>& objects, FileReport& report) {
  std::ranges::stable_sort(objects, {}, [](const Object* object) { return object->id(); });
  const auto again = [&](const Object* kept, const Object* next) {
    const bool same = kept->id() == next->id();
    if (same) {
      report.add(Problem::kDuplicate, id_of(*next));
    }
    return same;
  };
  objects.erase(std::unique(objects.begin(), objects.end(), again), objects.end());
}

}  // namespace

void OsmObjects::charge(std::size_t bytes) {
  kept_bytes_ += bytes;
  if (kept_bytes_ > limit_bytes_) {
    throw TooManyObjects{"holds more than " + std::to_string(limit_bytes_ / 1'000'000) +
                         " MB of nodes, ways and relations, which is more than a city; cut it "
                         "first, such as by: osmium extract --bbox W,S,E,N"};
  }
}

void OsmObjects::keep(const osmium::OSMObject& object) {
  if (!object.visible()) {
    return;
  }
  if (object.type() == osmium::item_type::node) {
    charge(sizeof(nodes_.front()));
    nodes_.emplace_back(object.id(), static_cast<const osmium::Node&>(object).location());
  } else {
    charge(object.padded_size());
    buffer_.add_item(object);
    buffer_.commit();
  }
}

void OsmObjects::sort_nodes(FileReport& report) {
  std::ranges::stable_sort(nodes_, {}, &std::pair<std::int64_t, osmium::Location>::first);
  const auto again = [&](const auto& kept, const auto& next) {
    const bool same = kept.first == next.first;
    if (same) {
      report.add(Problem::kDuplicate, {ObjectType::kNode, next.first});
    }
    return same;
  };
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end(), again), nodes_.end());
  for (const auto& [id, location] : nodes_) {
    if (location.valid()) {
      const GeoBox place{location.lon(), location.lat(), location.lon(), location.lat()};
      extent_ = extent_.value_or(place);
      extent_->extend(place);
    }
  }
}

osmium::Location OsmObjects::location_of(std::int64_t id) const {
  const auto found =
      std::ranges::lower_bound(nodes_, id, {}, &std::pair<std::int64_t, osmium::Location>::first);
  const bool usable = found != nodes_.end() && found->first == id && found->second.valid();
  return usable ? found->second : osmium::Location{};
}

void OsmObjects::index(FileReport& report) {
  sort_nodes(report);
  for (auto& way : buffer_.select<osmium::Way>()) {
    for (auto& node : way.nodes()) {
      node.set_location(location_of(node.ref()));
    }
    ways_.push_back(&way);
  }
  for (const auto& relation : buffer_.select<osmium::Relation>()) {
    relations_.push_back(&relation);
  }
  report.nodes = nodes_.size();
  sort_unique(ways_, report);
  report.ways = ways_.size();
  sort_unique(relations_, report);
  report.relations = relations_.size();
}

const osmium::Way* OsmObjects::way(std::int64_t id) const {
  const auto found =
      std::ranges::lower_bound(ways_, id, {}, [](const osmium::Way* way) { return way->id(); });
  return found != ways_.end() && (*found)->id() == id ? *found : nullptr;
}

Tags known_tags(const osmium::TagList& tags) {
  static constexpr std::array<std::string_view, 24> kKeys{"building",
                                                          "building:part",
                                                          "name",
                                                          "height",
                                                          "building:levels",
                                                          "min_height",
                                                          "location",
                                                          "building:min_level",
                                                          "roof:height",
                                                          "roof:levels",
                                                          "building:material",
                                                          "building:facade:material",
                                                          "layer",
                                                          "natural",
                                                          "landuse",
                                                          "highway",
                                                          "width",
                                                          "lanes",
                                                          "tunnel",
                                                          "diameter_crown",
                                                          "est_height",
                                                          "area",
                                                          "covered",
                                                          "indoor"};
  Tags known;
  for (const auto& tag : tags) {
    if (std::ranges::find(kKeys, std::string_view{tag.key()}) != kKeys.end()) {
      known.add(tag.key(), tag.value());
    }
  }
  return known;
}

}  // namespace cuscus::city
