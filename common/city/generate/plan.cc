#include "common/city/generate/plan.h"

#include <fmt/core.h>

#include <stdexcept>

namespace cuscus::city::generate {

Eigen::Vector2d snapped(const Eigen::Vector2d& point_m) {
  return (point_m * 1000.0).array().round() / 1000.0;
}

void check_size(double size_m) {
  if (!(size_m >= kSmallestCity_m && size_m <= kLargestCity_m)) {
    throw std::invalid_argument{fmt::format("a city of {} m cannot be made; allowed: {} m ... {} m",
                                            size_m, kSmallestCity_m, kLargestCity_m)};
  }
}

}  // namespace cuscus::city::generate
