#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <span>

namespace cuscus::world {

/// The least squares solution of a position and a receiver's clock by ranges to satellites in the
/// directions e_k (of length 1, from the receiver):
///
///   Q = (GᵀG)⁻¹, rows of G: (-e_kᵀ, 1);   δ = Q Gᵀ ε,
///
/// where ε are the errors of the ranges and δ that of the position and of the clock (times the
/// speed of light). Independent errors of one deviation σ make position errors of deviation σ
/// sqrt(Q_11 + Q_22) in the level and σ sqrt(Q_33) upwards: HDOP and VDOP. All ranges weigh the
/// same.
///
/// Source: E. D. Kaplan, C. J. Hegarty, "Understanding GPS", 2nd edition, 2006, 7.3.1.
class PositionSolution {
 public:
  /// Nothing of fewer than four directions, or of such whose PDOP is above kGreatestPdop: nearly on
  /// one cone, which leaves a direction open.
  [[nodiscard]] static std::optional<PositionSolution> of(
      std::span<const Eigen::Vector3d> directions);

  /// The filter that u-blox receivers have where nothing else is set (M8: CFG-NAV5, pDop).
  static constexpr double kGreatestPdop = 25.0;

  [[nodiscard]] double hdop() const { return std::sqrt(cofactors_(0, 0) + cofactors_(1, 1)); }
  [[nodiscard]] double vdop() const { return std::sqrt(cofactors_(2, 2)); }
  [[nodiscard]] double pdop() const { return std::sqrt(cofactors_.diagonal().head<3>().sum()); }

  /// What `range_errors`, one per direction, make of the position.
  [[nodiscard]] Eigen::Vector3d error(std::span<const Eigen::Vector3d> directions,
                                      std::span<const double> range_errors) const;

 private:
  explicit PositionSolution(const Eigen::Matrix4d& cofactors) : cofactors_{cofactors} {}

  Eigen::Matrix4d cofactors_;
};

}  // namespace cuscus::world
