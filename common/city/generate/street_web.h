#pragma once

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "common/city/generate/convex_cell.h"

namespace cuscus::city::generate {

/// The borders of cells as streets: at every junction, the two borders that go most nearly straight
/// on are one street, unless it would bend by more than 60 degrees.
struct StreetWeb {
  struct Street {
    std::vector<Eigen::Vector2d> axis_m;
    double length_m{0.0};
    bool outer{false};  ///< On the area's own border.
  };
  std::vector<Street> streets;
  std::map<std::pair<int, int>, std::size_t> street_between;  ///< By cells, the lower number first.

  [[nodiscard]] std::size_t street_of(int cell, int across) const;
};

[[nodiscard]] StreetWeb street_web(const std::vector<ConvexCell>& cells);

}  // namespace cuscus::city::generate
