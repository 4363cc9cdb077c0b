#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/units/sim_time.h"
#include "orchestrator/results/formation_error.h"

namespace cuscus::orchestrator {

/// Where every UAV of a circling fleet should be: the vertices of a regular polygon that turns at
/// the mission's speed.
///
/// The paper's formation error is the distance to "the position that nodes should be at, when their
/// control system does not use the network for exchanging position data" (section 5.1): what
/// control alone would give. That is the ring turning at speed / radius. Which phase it has is up
/// to the fleet, so it is taken from the fleet itself, once: when its shape has held for
/// kFormedFor. Until then the phase is the one that suits the fleet best at each instant, and the
/// error is that of the shape alone (formation_error()). From then on it also tells a fleet that
/// keeps its shape but turns too slowly, which is what old knowledge of the neighbours does to it
/// (docs/models/circle.md).
class FormationReference {
 public:
  /// The shape holds while no UAV is further than this from its vertex.
  static constexpr double kFormedWithin_m = 0.5;
  /// Longer than a fleet takes from hovering at its vertices to the speed of the mission.
  static constexpr SimClock::duration kFormedFor = std::chrono::seconds{5};

  /// `speed_mps` along the circle, counter-clockwise seen from above.
  FormationReference(const FormationCircle& circle, double speed_mps)
      : circle_{circle}, speed_radps_{speed_mps / circle.radius_m} {}

  /// Distance of each member from its vertex [m], in the members' order. Times must not fall.
  [[nodiscard]] std::vector<double> errors_m(SimTime now, std::span<const FormationMember> members);

  /// When the ring's phase was fixed; nothing before.
  [[nodiscard]] const std::optional<SimTime>& formed_at() const noexcept { return formed_at_; }

 private:
  FormationCircle circle_;
  double speed_radps_;
  std::optional<SimTime> holds_since_;
  std::optional<SimTime> formed_at_;
  double phase_at_formed_rad_{0.0};
};

}  // namespace cuscus::orchestrator
