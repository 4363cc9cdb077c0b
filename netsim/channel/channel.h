#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/units/decibel.h"
#include "netsim/channel/box_obstacles.h"
#include "netsim/channel/fading.h"
#include "netsim/channel/link.h"
#include "netsim/channel/obstacle_loss.h"
#include "netsim/channel/obstacles.h"
#include "netsim/channel/path_loss.h"
#include "netsim/channel/shadowing.h"
#include "netsim/channel/two_ray.h"
#include "netsim/makers/maker.h"

namespace cuscus::netsim {

/// A loss drawn anew for every transmission over an unordered link: the paper's Ψ, a normal
/// variable of mean 0 and *variance* χ [dB²].
///
/// A pure function of (seed, link, who sends, which transmission): the same in whatever order links
/// are asked for. There is no correlation in space or time, as in the source (see PaperEquation1).
class FrameVariation final {
 public:
  FrameVariation(std::uint64_t seed, double variance_db2);

  [[nodiscard]] Decibel loss(const FrameOnLink& frame) const;

 private:
  std::uint64_t seed_;
  double deviation_db_;
};

struct ChannelParameters;
using PathLossMaker = Maker<const PathLossModel, ChannelParameters>;

/// What a scenario says about propagation.
struct ChannelParameters {
  std::string model{"friis"};
  double carrier_hz{2.412e9};
  double exponent{2.0};              ///< log-distance: n.
  Decibel reference_loss{0.0};       ///< log-distance: at 1 m, 0 = free space; fixed: the loss.
  double alpha{20.0};                ///< paper-eq1.
  double chi_db2{0.0};               ///< paper-eq1: variance of Ψ.
  Decibel outer_wall{12.0};          ///< paper-eq1: γ_W, of each outer wall.
  Decibel inner_wall{5.0};           ///< paper-eq1: γ_w, of each inner wall.
  std::string ground{"medium-dry"};  ///< two-ray.
  Polarisation polarisation{Polarisation::kVertical};  ///< two-ray.
  double roughness_m{0.0};             ///< two-ray: standard deviation of the ground's height.
  std::string canyon_bound{"middle"};  ///< p1411.
  std::string environment{"urban"};    ///< al-hourani.
  std::string area{"UMa-AV"};          ///< tr36777: its scenario.
  std::string line_of_sight{"drawn"};  ///< al-hourani, tr36777: or "mean".
  double line_of_sight_decorrelation_m{50.0};  ///< al-hourani, tr36777: of the draw.
  double shadowing_db{0.0};                    ///< Standard deviation; 0: no shadowing.
  double shadowing_decorrelation_m{20.0};
  std::string fading{"none"};                                  ///< "none", "rice" or "nakagami".
  Decibel k_factor{-std::numeric_limits<double>::infinity()};  ///< rice; -inf: Rayleigh.
  Decibel k_factor_overhead{-std::numeric_limits<double>::infinity()};  ///< rice: at the zenith.
  double residual_doppler_hz{1.0};                                      ///< rice.
  double nakagami_m{1.0};
  std::vector<BoxObstacle> obstacles{};
  std::shared_ptr<const Obstacles> city{};  ///< Further obstacles; may be none.
  std::string walls{"paper"};               ///< Of the city: or "p2040".
  std::string city_file{};  ///< Where a log's reader finds the city, beside the log; empty: none.
  std::uint64_t seed{1};
  std::vector<PathLossMaker> more_models{};  ///< That `model` may name besides ours.
};

/// The part of a link's loss that depends on the positions alone, term by term.
struct StaticTerms {
  Decibel basic{};
  ObstacleTerms obstacles{};
  Decibel shadowing{};

  /// In this order, so that equation 1 of the paper is exact.
  [[nodiscard]] Decibel sum() const {
    return basic + obstacles.outer_walls + obstacles.inner_walls + obstacles.diffraction +
           obstacles.foliage + shadowing;
  }
};

/// The part that changes from frame to frame.
struct FrameTerms {
  Decibel variation{};  ///< Ψ.
  Decibel fading{};

  [[nodiscard]] Decibel sum() const { return variation + fading; }
};

/// The channel of a run,
///
///   loss = basic(d) + obstacles(r_L, r_H) + shadowing(r_L, r_H) + Ψ(frame) + fading(r_L, r_H, t).
///
/// Every term is a pure function of (seed, unordered link, positions, frame, time): the same in
/// both directions and in whatever order links are asked for. There is one term of each kind.
///
/// Obstacles: ObstacleTerms, but with `paper-eq1` n_W γ_W + n_w γ_w of its equation 1, without
/// diffraction and whatever the bodies' own walls are.
class Channel {
 public:
  /// With the boxes of the parameters as obstacles.
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  explicit Channel(const ChannelParameters& parameters);
  /// With these obstacles, which may be none, instead.
  Channel(const ChannelParameters& parameters, std::shared_ptr<const Obstacles> obstacles);

  /// Names that ChannelParameters::model may hold.
  [[nodiscard]] static std::vector<std::string> model_names();

  /// May be kept while nobody moves.
  [[nodiscard]] StaticTerms static_terms(const Link& link) const;
  /// Whether anything may be in the way of a link.
  [[nodiscard]] bool has_obstacles() const { return obstacles_ != nullptr; }
  /// Replaces `nearby` by what may be in the way of links whose ends are at most `slack_m` from
  /// this one's. There must be obstacles.
  void look_around(const Link& link, double slack_m, Nearby& nearby) const;
  /// The terms of such a link, without a search: the same to the bit.
  [[nodiscard]] StaticTerms static_terms(const Link& link, const Nearby& nearby) const;
  [[nodiscard]] Decibel static_loss(const Link& link) const { return static_terms(link).sum(); }

  /// Whether frame_loss() is ever other than zero.
  [[nodiscard]] bool varies_per_frame() const {
    return variation_ != nullptr || fading_ != nullptr;
  }
  [[nodiscard]] FrameTerms frame_terms(const FrameOnLink& frame) const;
  [[nodiscard]] Decibel frame_loss(const FrameOnLink& frame) const {
    return frame_terms(frame).sum();
  }
  /// frame_loss() is never below minus this; +inf: there is no bound.
  [[nodiscard]] Decibel greatest_frame_gain() const;

 private:
  [[nodiscard]] StaticTerms terms_of(const Link& link, const Nearby* nearby) const;
  [[nodiscard]] ObstacleTerms obstacle_terms_of(const Link& link, const Nearby* nearby) const;

  double carrier_hz_;
  bool counts_walls_;  ///< Equation 1 of the paper.
  Decibel outer_wall_;
  Decibel inner_wall_;
  std::unique_ptr<const PathLossModel> path_loss_;
  std::shared_ptr<const Obstacles> obstacles_;
  std::unique_ptr<const Shadowing> shadowing_;
  std::unique_ptr<const FrameVariation> variation_;
  std::unique_ptr<const FadingModel> fading_;
};

}  // namespace cuscus::netsim
