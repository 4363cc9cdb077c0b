#include "common/city/generate/osm_elements.h"

#include <fmt/format.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/city/generate/osm_writer.h"

namespace cuscus::city::generate {
namespace {

constexpr std::int64_t kStepsPerDegree = 1'000'000'000;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

void write_tags(const Tags& tags, std::string& out) {
  for (const Tag& tag : tags) {
    fmt::format_to(std::back_inserter(out), "    <tag k=\"{}\" v=\"{}\"/>\n", escaped(tag.key),
                   escaped(tag.value));
  }
}

/// Opens an element that may have content, writes that, and closes it.
void write_element(const char* type, const std::string& attributes, const std::string& content,
                   std::string& out) {
  if (content.empty()) {
    fmt::format_to(std::back_inserter(out), "  <{} {}/>\n", type, attributes);
  } else {
    fmt::format_to(std::back_inserter(out), "  <{0} {1}>\n{2}  </{0}>\n", type, attributes,
                   content);
  }
}

/// Bounds around the points whose middle is the origin, whatever the earth's curve does to them.
std::string bounds(const OsmPoint& origin, const std::vector<OsmPoint>& points) {
  OsmPoint reach{0, 0};
  for (const OsmPoint& point : points) {
    reach.latitude = std::max(reach.latitude, std::abs(point.latitude - origin.latitude));
    reach.longitude = std::max(reach.longitude, std::abs(point.longitude - origin.longitude));
  }
  return fmt::format(
      "  <bounds minlat=\"{}\" minlon=\"{}\" maxlat=\"{}\" maxlon=\"{}\"/>\n",
      degrees(origin.latitude - reach.latitude), degrees(origin.longitude - reach.longitude),
      degrees(origin.latitude + reach.latitude), degrees(origin.longitude + reach.longitude));
}

}  // namespace

OsmPoint osm_point(const Eigen::Vector2d& p_m, const Geodetic& origin) {
  const GeographicLib::LocalCartesian frame{origin.latitude_deg, origin.longitude_deg, 0.0};
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double height_m = 0.0;
  double up_m = 0.0;
  // The tangent plane rises above the ellipsoid; two rounds bring the point down on it, to less
  // than a nanometre for a city.
  for (int round = 0; round < 3; ++round) {
    frame.Reverse(p_m.x(), p_m.y(), up_m, latitude_deg, longitude_deg, height_m);
    up_m -= height_m;
  }
  return {std::llround(latitude_deg * kStepsPerDegree),
          std::llround(longitude_deg * kStepsPerDegree)};
}

std::string degrees(std::int64_t steps) {
  const std::int64_t size = std::abs(steps);
  return fmt::format("{}{}.{:09d}", steps < 0 ? "-" : "", size / kStepsPerDegree,
                     size % kStepsPerDegree);
}

std::int64_t OsmElements::node_at(const Eigen::Vector2d& p_m) {
  const OsmPoint point = osm_point(p_m, origin_);
  const auto [found, is_new] =
      node_by_point_.try_emplace(point, static_cast<std::int64_t>(nodes_.size()) + 1);
  if (is_new) {
    nodes_.push_back({point, {}});
  }
  return found->second;
}

void OsmElements::add_node(const Eigen::Vector2d& p_m, Tags tags) {
  nodes_.push_back({osm_point(p_m, origin_), std::move(tags)});
}

std::int64_t OsmElements::add_way(const std::vector<Eigen::Vector2d>& points_m, Tags tags) {
  Way way{.nodes = {}, .tags = std::move(tags)};
  for (const Eigen::Vector2d& point : points_m) {
    way.nodes.push_back(node_at(point));
  }
  ways_.push_back(std::move(way));
  return static_cast<std::int64_t>(ways_.size());
}

std::int64_t OsmElements::add_ring(const Ring& ring, Tags tags) {
  Ring closed = ring;
  closed.push_back(ring.front());
  return add_way(closed, std::move(tags));
}

void OsmElements::add_area(const Footprint& footprint, Tags tags) {
  if (footprint.courtyards.empty()) {
    add_ring(footprint.outer, std::move(tags));
    return;
  }
  Relation relation;
  relation.members.push_back({add_ring(footprint.outer, {}), "outer"});
  for (const Ring& courtyard : footprint.courtyards) {
    relation.members.push_back({add_ring(courtyard, {}), "inner"});
  }
  relation.tags = std::move(tags);
  relation.tags.insert(relation.tags.begin(), {"type", "multipolygon"});
  relations_.push_back(std::move(relation));
}

std::string OsmElements::xml(const Eigen::Vector2d& south_west_m,
                             const Eigen::Vector2d& north_east_m) const {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  fmt::format_to(std::back_inserter(out), "<osm version=\"0.6\" generator=\"{}\">\n",
                 kOsmGenerator);
  out += bounds(osm_point({0.0, 0.0}, origin_),
                {osm_point(south_west_m, origin_), osm_point(north_east_m, origin_),
                 osm_point({south_west_m.x(), north_east_m.y()}, origin_),
                 osm_point({north_east_m.x(), south_west_m.y()}, origin_)});
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::string content;
    write_tags(nodes_[i].tags, content);
    write_element(
        "node",
        fmt::format("id=\"{}\" version=\"1\" lat=\"{}\" lon=\"{}\"", i + 1,
                    degrees(nodes_[i].point.latitude), degrees(nodes_[i].point.longitude)),
        content, out);
  }
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    std::string content;
    for (const std::int64_t node : ways_[i].nodes) {
      fmt::format_to(std::back_inserter(content), "    <nd ref=\"{}\"/>\n", node);
    }
    write_tags(ways_[i].tags, content);
    write_element("way", fmt::format("id=\"{}\" version=\"1\"", i + 1), content, out);
  }
  for (std::size_t i = 0; i < relations_.size(); ++i) {
    std::string content;
    for (const Member& member : relations_[i].members) {
      fmt::format_to(std::back_inserter(content),
                     "    <member type=\"way\" ref=\"{}\" role=\"{}\"/>\n", member.way,
                     member.role);
    }
    write_tags(relations_[i].tags, content);
    write_element("relation", fmt::format("id=\"{}\" version=\"1\"", i + 1), content, out);
  }
  return out + "</osm>\n";
}

}  // namespace cuscus::city::generate
