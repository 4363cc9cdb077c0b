#include "common/city/export/height_classes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cuscus::city {
namespace {

constexpr double kWantedClasses = 7.0;
constexpr double kRarest = 0.02;
constexpr double kSmallestStep_m = 0.5;

}  // namespace

double round_step(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1.0 - 1e-9)) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

HeightClasses::HeightClasses(const City& city) {
  std::vector<double> heights_m;
  for (const Building& building : city.buildings) {
    for (const Prism& prism : building.prisms) {
      heights_m.push_back(prism.top_m);
    }
  }
  if (heights_m.empty()) {
    return;
  }
  std::sort(heights_m.begin(), heights_m.end());
  const auto at = [&](double part) {
    return heights_m[static_cast<std::size_t>(part * static_cast<double>(heights_m.size() - 1))];
  };
  const double low_m = at(kRarest);
  const double high_m = at(1.0 - kRarest);
  const double step_m = round_step(std::max((high_m - low_m) / kWantedClasses, kSmallestStep_m));
  const auto first = static_cast<int>(std::floor(low_m / step_m)) + 1;
  for (int i = first; i * step_m <= high_m; ++i) {
    bounds_m_.push_back(i * step_m);
  }
}

std::size_t HeightClasses::class_of(double height_m) const {
  return static_cast<std::size_t>(std::upper_bound(bounds_m_.begin(), bounds_m_.end(), height_m) -
                                  bounds_m_.begin());
}

std::string HeightClasses::label(std::size_t number) const {
  if (bounds_m_.empty()) {
    return "all buildings";
  }
  if (number == 0) {
    return fmt::format("below {:g} m", bounds_m_.front());
  }
  if (number == bounds_m_.size()) {
    return fmt::format("{:g} m and more", bounds_m_.back());
  }
  return fmt::format("{:g} - {:g} m", bounds_m_[number - 1], bounds_m_[number]);
}

}  // namespace cuscus::city
