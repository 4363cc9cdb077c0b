#include "common/city/geometry/orientation.h"

#include <array>
#include <cstddef>

namespace cuscus::city {
namespace {

/// A sum of doubles without rounding: its terms do not overlap and grow.
class ExactSum {
 public:
  void add(double term) {
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = term + terms_[i];
      const double virtual_term = sum - terms_[i];
      terms_[i] = (term - virtual_term) + (terms_[i] - (sum - virtual_term));
      term = sum;
    }
    terms_[size_++] = term;
  }

  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }

  /// The highest term that is not 0: it has the sign of the sum, and nearly its size.
  [[nodiscard]] double leading() const {
    for (std::size_t i = size_; i > 0; --i) {
      if (terms_[i - 1] != 0.0) {
        return terms_[i - 1];
      }
    }
    return 0.0;
  }

 private:
  std::array<double, 12> terms_{};
  std::size_t size_{0};
};

}  // namespace

double exact_orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                         const Eigen::Vector2d& c) {
  ExactSum sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(b.x(), c.y());
  sum.add_product(-b.y(), c.x());
  sum.add_product(c.x(), a.y());
  sum.add_product(-c.y(), a.x());
  return sum.leading();
}

}  // namespace cuscus::city
