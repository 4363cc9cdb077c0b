#include "common/city/geometry/orientation.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace cuscus::city {
namespace {

int sign(double x) { return (x > 0.0 ? 1 : 0) - (x < 0.0 ? 1 : 0); }

TEST_CASE("the side of a line is exact where rounding alone would be wrong") {
  // Points within some units in the last place of (0.5, 0.5), against the diagonal through (12, 12)
  // and (24, 24): after Kettner et al., "Classroom Examples of Robustness Problems", 2008.
  const Eigen::Vector2d q{12.0, 12.0};
  const Eigen::Vector2d r{24.0, 24.0};
  int rounded_wrong = 0;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Eigen::Vector2d p{0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53};
      const int expected = sign(p.y() - p.x());
      CHECK(sign(orientation(q, r, p)) == expected);
      CHECK(sign(orientation(r, q, p)) == -expected);
      CHECK(sign(orientation(p, q, r)) == expected);
      const double rounded = (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
      rounded_wrong += sign(rounded) != expected ? 1 : 0;
    }
  }
  CHECK(rounded_wrong > 100);
}

TEST_CASE("orientation is twice the area, positive to the left") {
  CHECK(orientation({0.0, 0.0}, {4.0, 0.0}, {0.0, 3.0}) == 12.0);
  CHECK(orientation({0.0, 0.0}, {4.0, 0.0}, {0.0, -3.0}) == -12.0);
  CHECK(orientation({0.0, 0.0}, {4.0, 0.0}, {9.0, 0.0}) == 0.0);
}

}  // namespace
}  // namespace cuscus::city
