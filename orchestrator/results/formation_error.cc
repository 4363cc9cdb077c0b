#include "orchestrator/results/formation_error.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>

namespace cuscus::orchestrator {
namespace {

void check_input(const FormationCircle& circle, std::span<const FormationMember> members) {
  if (members.empty()) {
    throw std::invalid_argument{"formation error: a fleet of no UAV"};
  }
  if (!std::isfinite(circle.radius_m) || circle.radius_m <= 0.0) {
    throw std::invalid_argument{"formation error: radius " + std::to_string(circle.radius_m) +
                                " m, must be above 0"};
  }
  std::vector<bool> taken(members.size(), false);
  for (const FormationMember& member : members) {
    if (member.slot >= members.size() || taken[member.slot]) {
      throw std::invalid_argument{"formation error: slot " + std::to_string(member.slot) + " of " +
                                  std::to_string(members.size()) +
                                  " is outside the formation or taken twice"};
    }
    taken[member.slot] = true;
  }
}

double slot_angle_rad(std::uint32_t slot, std::size_t n) {
  return 2.0 * std::numbers::pi * slot / static_cast<double>(n);
}

/// arg of the sum of unit vectors; a sum that is nothing but rounding counts as 0.
double common_phase_rad(const FormationCircle& circle, std::span<const FormationMember> members) {
  constexpr double kRounding = 1e-12;
  std::complex<double> sum{0.0, 0.0};
  for (const FormationMember& member : members) {
    const Eigen::Vector3d p_CB_m = member.p_WB_m - circle.p_WC_m;
    if (p_CB_m.x() != 0.0 || p_CB_m.y() != 0.0) {
      const double azimuth_rad = std::atan2(p_CB_m.y(), p_CB_m.x());
      sum += std::polar(1.0, azimuth_rad - slot_angle_rad(member.slot, members.size()));
    }
  }
  return std::abs(sum) > kRounding * static_cast<double>(members.size()) ? std::arg(sum) : 0.0;
}

}  // namespace

FormationError formation_error(const FormationCircle& circle,
                               std::span<const FormationMember> members) {
  check_input(circle, members);
  FormationError result{.phase_rad = common_phase_rad(circle, members),
                        .error_m = {},
                        .mean_m = 0.0,
                        .rms_m = 0.0,
                        .max_m = 0.0};
  const auto n = static_cast<double>(members.size());
  double sum_of_squares_m2 = 0.0;
  for (const FormationMember& member : members) {
    const double angle_rad = result.phase_rad + slot_angle_rad(member.slot, members.size());
    const Eigen::Vector3d p_WR_m =
        circle.p_WC_m +
        circle.radius_m * Eigen::Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0.0};
    const double error_m = (member.p_WB_m - p_WR_m).norm();
    result.error_m.push_back(error_m);
    result.mean_m += error_m / n;
    result.max_m = std::max(result.max_m, error_m);
    sum_of_squares_m2 += error_m * error_m;
  }
  result.rms_m = std::sqrt(sum_of_squares_m2 / n);
  return result;
}

}  // namespace cuscus::orchestrator
