#include "netsim/phy/link_error_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "common/units/decibel.h"

namespace cuscus::netsim {
namespace {

constexpr double kStep_db = 0.5;
constexpr std::size_t kMostPoints = 20;

struct Curve {
  Modulation modulation;
  CodeRate code_rate;
  double first_db;
  std::array<double, kMostPoints> points;  ///< lg p; 0 after the last.

  [[nodiscard]] constexpr std::size_t size() const {
    std::size_t n = 0;
    while (n < points.size() && points[n] < 0.0) {
      ++n;
    }
    return n;
  }
};

constexpr std::array kCurves{
#include "netsim/phy/link_error_table.inc"
};

const Curve& curve_of(Modulation modulation, CodeRate code_rate) {
  return *std::find_if(kCurves.begin(), kCurves.end(), [&](const Curve& curve) {
    return curve.modulation == modulation && curve.code_rate == code_rate;
  });
}

}  // namespace

double LinkErrorModel::bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const {
  if (code_rate == CodeRate::kUncoded) {
    return dsss_bit_failure(modulation, sinr_ratio);
  }
  if (sinr_ratio <= 0.0) {
    return 1.0;
  }
  const Curve& curve = curve_of(modulation, code_rate);
  const double position = (10.0 * std::log10(sinr_ratio) - curve.first_db) / kStep_db;
  const auto last = static_cast<double>(curve.size() - 2);
  const double below = std::clamp(std::floor(position), 0.0, last);
  const double* const pair = curve.points.data() + static_cast<std::size_t>(below);
  return std::min(1.0, std::pow(10.0, pair[0] + (position - below) * (pair[1] - pair[0])));
}

}  // namespace cuscus::netsim
