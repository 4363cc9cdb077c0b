#pragma once

#include <Eigen/Core>
#include <stdexcept>

namespace cuscus::city {

template <class... Points>
void require_finite(const Points&... points) {
  if (!(points.allFinite() && ...)) {
    throw std::invalid_argument{"city geometry: coordinates must be finite"};
  }
}

/// A range, a radius or a margin.
inline void require_reach(double reach_m) {
  if (!(reach_m >= 0.0)) {
    throw std::invalid_argument{"city geometry: ranges and radii must be 0 m or more"};
  }
}

}  // namespace cuscus::city
