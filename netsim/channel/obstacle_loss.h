#pragma once

#include <span>

#include "netsim/channel/obstacles.h"

namespace cuscus::netsim {

/// Share of the power that passes a knife edge, 10^(-J(ν)/10) with
///
///   J(ν) = 6.9 + 20 log₁₀(√((ν - 0.1)² + 1) + ν - 0.1)  dB   for ν > -0.78, else 0:
///
/// a quarter where the ray just grazes it, all where it clears it by 0.55 of the first Fresnel
/// zone's radius. Source: Recommendation ITU-R P.526, section 4.1, which leaves an error below 0.1
/// dB and, as here, the ripple of a cleared edge out.
[[nodiscard]] double knife_edge_share(double fresnel_parameter);

/// Clearances from here on [m] leave the ray alone: see Obstruction::clearance_m.
[[nodiscard]] double clear_zone_m(double wavelength_m);

/// The loss by what is in the way of a link, part by part; their sum is the obstacles' loss.
struct ObstacleTerms {
  WallCount walls{};
  Decibel outer_walls{};
  Decibel inner_walls{};
  /// What goes around the bodies: negative where that is more than what comes through, positive
  /// where bodies that the ray only grazes take some of it.
  Decibel diffraction{};
  Decibel foliage{};

  [[nodiscard]] Decibel sum() const { return outer_walls + inner_walls + diffraction + foliage; }
};

/// What comes through the bodies and what goes around them, added as powers. One body that the ray
/// crosses lets through
///
///   P = U 10^(-W/10) + p₀ (1 - U),   U = Π_i (1 - p(ν_i) / p₀),
///
/// with W the loss of its walls, i the ways over the roof and around either side, p
/// knife_edge_share(), p₀ = p(0); deep in the shade this is 10^(-W/10) + Σ_i p(ν_i), and where the
/// ray comes to the brink of the body on any way it is p₀. One that it clears lets P = p(-ν)
/// through. So P is continuous, about 6 dB at grazing and 0 dB where the first Fresnel zone is
/// free. For each way the edges are one of Bullington's, where the tangents from both ends meet;
///
///   ν = 2 √(Δ / λ),
///
/// with Δ by how much the path by way of it, or of the body's nearest point, is longer than the
/// ray: P.526's ν for small angles, and finite next to a wall. Around an end inside there is no
/// way.
///
/// Several bodies: the product of their P, or, where that is more, what passes those that any one
/// edge of Bullington's clears on one way, times the P of the others; the former then lose p₀ + (1
/// - p₀) U each, so that a body counts as soon as it does alone.
///
/// Sources: Recommendation ITU-R P.526, "Single knife-edge obstacle" (J, ν) and "Finite-width
/// screen" (the average loss adds the powers over the top and around both sides); K. Bullington,
/// Proc. IRE 35(10), 1947. U and p₀ are ours. Valid for distances ≫ λ. What is near an edge adds up
/// as waves in truth: walls of a few dB are rated too high at grazing, by 6 dB in the limit of no
/// wall. Reflections and ways below a body are left out.
/// Checked in obstacle_loss_test.cc.
[[nodiscard]] ObstacleTerms obstacle_terms(std::span<const Obstruction> found,
                                           const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                                           double wavelength_m);

}  // namespace cuscus::netsim
