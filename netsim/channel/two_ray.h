#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "netsim/channel/path_loss.h"

namespace cuscus::netsim {

enum class Polarisation : std::uint8_t { kVertical, kHorizontal };

/// A direct ray and one reflected by flat ground at z = 0, added as waves,
///
///   L = -20 log₁₀ |λ/4π · (e^(-jk d₁)/d₁ + ρ Γ e^(-jk d₂)/d₂)|  dB,
///   Γ_v = (ε sin ψ - √(ε - cos² ψ)) / (ε sin ψ + √(ε - cos² ψ)),
///   Γ_h = (sin ψ - √(ε - cos² ψ)) / (sin ψ + √(ε - cos² ψ)),
///   ε = a f^b - j 60 λ c f^d,   ρ = exp(-2 (k s sin ψ)²),
///
/// with d₁ and d₂ the lengths of the rays [m], ψ the grazing angle, k = 2π/λ, f the frequency
/// [GHz], s the standard deviation of the ground's height [m].
///
/// Sources: T. S. Rappaport, "Wireless Communications", 2nd ed., 2002, sections 4.5 and 4.6; ground
/// constants of Recommendation ITU-R P.527 in the form of P.2040-3, table 3 (1 to 10 GHz);
/// roughness: W. S. Ament, Proc. IRE 41(1), 1953. Between UAVs the lobes matter, several dB to
/// either side of free space; the fall with d⁻⁴ begins beyond 4π h₁h₂/λ only, kilometres away.
/// Antennas nearer than 0.1 m to the ground are taken to be there: at the ground itself the rays
/// would cancel.
class TwoRay final : public PathLossModel {
 public:
  struct Parameters {
    std::string ground{"medium-dry"};  ///< See ground_names().
    Polarisation polarisation{Polarisation::kVertical};
    double roughness_m{0.0};
  };

  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  explicit TwoRay(const Parameters& parameters);

  [[nodiscard]] static std::vector<std::string> ground_names();

  [[nodiscard]] Decibel loss(const LinkGeometry& link) const override;

 private:
  struct Ground;

  const Ground* ground_;
  Polarisation polarisation_;
  double roughness_m_;
};

}  // namespace cuscus::netsim
