#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/units/decibel.h"
#include "netsim/channel/path_loss.h"

namespace cuscus::netsim {

/// One transmission over one link, for terms that change from frame to frame.
struct FrameOnLink {
  std::uint32_t sender;
  std::uint32_t receiver;
  std::uint64_t transmission;  ///< The sender's how-manieth, retries and ACKs included.
};

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

/// What a scenario says about propagation.
struct ChannelParameters {
  std::string model{"friis"};
  double carrier_hz{2.412e9};
  double exponent{2.0};         ///< log-distance: n.
  Decibel reference_loss{0.0};  ///< log-distance: at 1 m, 0 = free space; fixed: the loss.
  double alpha{20.0};           ///< paper-eq1.
  double chi_db2{0.0};          ///< paper-eq1: variance of Ψ.
  std::uint64_t seed{1};
};

/// The channel of a run: the chosen model with its per-frame term, if it has one.
class Channel {
 public:
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  explicit Channel(const ChannelParameters& parameters);

  /// Names that ChannelParameters::model may hold.
  [[nodiscard]] static std::vector<std::string> model_names();

  /// The part that depends on the geometry alone, and may be kept while nobody moves.
  [[nodiscard]] Decibel basic_loss(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p_WR) const;

  /// Whether frame_loss() is ever other than zero.
  [[nodiscard]] bool varies_per_frame() const { return variation_ != nullptr; }
  [[nodiscard]] Decibel frame_loss(const FrameOnLink& frame) const;

 private:
  double carrier_hz_;
  std::unique_ptr<const PathLossModel> path_loss_;
  std::unique_ptr<const FrameVariation> variation_;
};

}  // namespace cuscus::netsim
