#include "orchestrator/results/formation_reference.h"

#include <cmath>
#include <numbers>

namespace cuscus::orchestrator {

std::vector<double> FormationReference::errors_m(SimTime now,
                                                 std::span<const FormationMember> members) {
  if (!formed_at_) {
    FormationError shape = formation_error(circle_, members);
    if (shape.max_m > kFormedWithin_m) {
      holds_since_.reset();
    } else if (!holds_since_) {
      holds_since_ = now;
    } else if (now - *holds_since_ >= kFormedFor) {
      formed_at_ = now;
      phase_at_formed_rad_ = shape.phase_rad;
    }
    return std::move(shape.error_m);
  }
  const double phase_rad = phase_at_formed_rad_ + speed_radps_ * to_seconds(now - *formed_at_);
  const double gap_rad = 2.0 * std::numbers::pi / static_cast<double>(members.size());
  std::vector<double> errors_m;
  errors_m.reserve(members.size());
  for (const auto& member : members) {
    const double angle_rad = phase_rad + gap_rad * static_cast<double>(member.slot);
    const Eigen::Vector3d p_WR_m =
        circle_.p_WC_m +
        circle_.radius_m * Eigen::Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0.0};
    errors_m.push_back((member.p_WB_m - p_WR_m).norm());
  }
  return errors_m;
}

}  // namespace cuscus::orchestrator
