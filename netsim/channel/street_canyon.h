#pragma once

#include <string_view>

#include "netsim/channel/path_loss.h"

namespace cuscus::netsim {

/// Line of sight along a street, between two bounds around a break-point,
///
///   L_bp = |20 log₁₀(λ² / (8π h₁h₂))|,   R_bp = 4 h₁h₂ / λ,
///   lower = L_bp + 20 log₁₀(d / R_bp), beyond R_bp 40 log₁₀,
///   upper = L_bp + 20 + 25 log₁₀(d / R_bp), beyond R_bp 40 log₁₀,
///
/// h₁ and h₂ the heights of the antennas above the street at z = 0 [m], d their distance [m].
///
/// Source: Recommendation ITU-R P.1411, section 4.1, UHF range (300 MHz to 3 GHz). Before the
/// break-point the lower bound is 6 dB below free space: walls and street guide the wave. Heights
/// are taken as at least 1 m; no loss is below 0 dB. For antennas below the roofs: above them use
/// another model. Checked in tests/unit/netsim/channel/aerial_loss_test.cc.
class StreetCanyon final : public PathLossModel {
 public:
  /// `bound` is "lower", "upper", or "middle": half-way between.
  /// @throws std::invalid_argument naming these.
  explicit StreetCanyon(std::string_view bound);

  [[nodiscard]] Decibel loss(const LinkGeometry& link) const override;

 private:
  double share_of_upper_;
};

}  // namespace cuscus::netsim
