#include "netsim/phy/link_error_model.h"

#include <algorithm>
#include <array>
#include <cmath>

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
};

constexpr std::array kCurves{
#include "netsim/phy/link_error_table.inc"
};

/// Where the last pair of points of a curve begins.
constexpr std::size_t last_pair(const Curve& curve) {
  std::size_t points = 0;
  while (points < curve.points.size() && curve.points[points] < 0.0) {
    ++points;
  }
  return points - 2;
}

constexpr auto kLastPairs = [] {
  std::array<double, kCurves.size()> pairs{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = static_cast<double>(last_pair(kCurves[i]));
  }
  return pairs;
}();

std::size_t index_of(Modulation modulation, CodeRate code_rate) {
  const auto* const found = std::find_if(kCurves.begin(), kCurves.end(), [&](const Curve& curve) {
    return curve.modulation == modulation && curve.code_rate == code_rate;
  });
  return static_cast<std::size_t>(found - kCurves.begin());
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
  const std::size_t index = index_of(modulation, code_rate);
  const Curve& curve = kCurves[index];
  const double position = (10.0 * std::log10(sinr_ratio) - curve.first_db) / kStep_db;
  const double below = std::clamp(std::floor(position), 0.0, kLastPairs[index]);
  const double* const pair = curve.points.data() + static_cast<std::size_t>(below);
  return std::min(1.0, std::pow(10.0, pair[0] + (position - below) * (pair[1] - pair[0])));
}

}  // namespace cuscus::netsim
