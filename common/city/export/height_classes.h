#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// Classes of heights for a legend, with round bounds between them: most prisms of the city, less a
/// fiftieth at each end, are spread over them evenly in height.
class HeightClasses {
 public:
  explicit HeightClasses(const City& city);

  [[nodiscard]] std::size_t count() const { return bounds_m_.size() + 1; }
  [[nodiscard]] std::size_t class_of(double height_m) const;
  /// Such as "10 - 12 m", "below 10 m", "60 m and more".
  [[nodiscard]] std::string label(std::size_t number) const;

 private:
  std::vector<double> bounds_m_;  ///< Between classes, growing.
};

/// 1, 2 or 5 times a power of ten, at least `value`.
[[nodiscard]] double round_step(double value);

}  // namespace cuscus::city
