#pragma once

#include <cstdint>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

enum class DisruptionPhase : std::uint8_t { kFixed, kRandom };

/// What a scenario says about the disruption of the network.
struct DisruptionParameters {
  double fraction{0.0};  ///< γ as a ratio; 0: no disruption.
  SimClock::duration interval{std::chrono::seconds{1}};
  DisruptionPhase phase{DisruptionPhase::kFixed};
  SimClock::duration offset{0};  ///< Of the stretch in its interval, where the phase is fixed.
  std::uint64_t seed{1};
};

/// Network disruption: "the percentage of time, over a reference interval, where the communications
/// were completely jammed" (N. R. Zema et al., "CUSCUS", Ad Hoc Networks, 2018, section 5.2). With
/// γ the fraction and T the interval, stretch k is
///
///   [k T + φ_k, k T + φ_k + γ T),   φ_k = the offset, or uniform in [0, (1 - γ) T).
///
/// The source gives neither T nor φ. A stretch with a fixed offset may reach into the next
/// interval, and the one before the run's first interval reaches into it likewise; one at random
/// lies within its interval. A pure function of (seed, time). Checked in disruption_test.cc and
/// air_test.cc.
class Disruption final {
 public:
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  explicit Disruption(const DisruptionParameters& parameters);

  /// Whether any part of [from, to] is in a stretch; `from` must not be before the run.
  [[nodiscard]] bool overlaps(SimTime from, SimTime to) const;

 private:
  [[nodiscard]] SimTime stretch_begins(std::int64_t interval) const;

  DisruptionParameters parameters_;
  SimClock::duration length_;
};

}  // namespace cuscus::netsim
