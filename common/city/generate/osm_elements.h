#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city::generate {

struct Tag {
  std::string key;
  std::string value;
};
using Tags = std::vector<Tag>;

/// A point of OSM in steps of 1e-9 degrees, 0.1 mm.
struct OsmPoint {
  std::int64_t latitude{0};
  std::int64_t longitude{0};

  // NOLINTNEXTLINE(modernize-use-nullptr): the check takes its zero for a pointer
  auto operator<=>(const OsmPoint&) const = default;
};

/// Metres east and north of an origin to WGS-84, at the ellipsoid's height there.
[[nodiscard]] OsmPoint osm_point(const Eigen::Vector2d& p_m, const Geodetic& origin);

/// "44.493800000", of a number of 1e-9 degrees.
[[nodiscard]] std::string degrees(std::int64_t steps);

/// The elements of a file, numbered from 1 on for each type. Shapes that have a point in common
/// share its node.
class OsmElements {
 public:
  explicit OsmElements(const Geodetic& origin) : origin_{origin} {}

  void add_node(const Eigen::Vector2d& p_m, Tags tags);
  /// A way along the points; its number.
  std::int64_t add_way(const std::vector<Eigen::Vector2d>& points_m, Tags tags);
  /// A closed way, or a multipolygon when there are courtyards.
  void add_area(const Footprint& footprint, Tags tags);

  /// In the order that tools expect: nodes, ways, relations, each by number.
  [[nodiscard]] std::string xml(const Eigen::Vector2d& south_west_m,
                                const Eigen::Vector2d& north_east_m) const;

 private:
  struct Node {
    OsmPoint point;
    Tags tags;
  };
  struct Way {
    std::vector<std::int64_t> nodes;
    Tags tags;
  };
  struct Member {
    std::int64_t way{0};
    const char* role{""};
  };
  struct Relation {
    std::vector<Member> members;
    Tags tags;
  };

  std::int64_t node_at(const Eigen::Vector2d& p_m);
  std::int64_t add_ring(const Ring& ring, Tags tags);

  Geodetic origin_;
  std::vector<Node> nodes_;
  std::vector<Way> ways_;
  std::vector<Relation> relations_;
  std::map<OsmPoint, std::int64_t> node_by_point_;
};

}  // namespace cuscus::city::generate
