#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "netsim/channel/antenna.h"
#include "netsim/channel/channel.h"
#include "netsim/channel/jammer.h"

namespace cuscus::netsim {

/// Where the receivers are at one instant; see PositionSource.
struct Places {
  std::span<const Eigen::Vector3d> p_WN;
  std::span<const Eigen::Quaterniond> q_WN;  ///< Empty: all are level and face east.
  std::uint64_t version;
};

/// What all located jammers of a run bring to each node: jammer j of a fleet of N nodes is node
/// N + j of the channel, so that its links have shadows and fading of their own. Its power reaches
/// all nodes at the instant at which it goes on.
///
/// Positions are followed, and fading is drawn, whenever a jammer switches and every 10 ms while
/// one is on.
class Jamming final {
 public:
  static constexpr SimClock::duration kUpdatePeriod = std::chrono::milliseconds{10};

  /// `channel` and `antenna` (nothing: isotropic) must outlive this object; `antenna_gains` has one
  /// gain per node.
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  Jamming(const std::vector<JammerParameters>& jammers, const Band& band, const Channel& channel,
          const Antenna* antenna, std::vector<Decibel> antenna_gains);

  /// Total noise of the jammers that are on [mW], by node; valid until the next call.
  [[nodiscard]] std::span<const double> received_mw(SimTime now, const Places& places);
  /// When that may be other than at `now`.
  [[nodiscard]] std::optional<SimTime> next_change(SimTime now) const;

 private:
  struct Source {
    Jammer jammer;
    std::uint32_t number;                    ///< As a node of the channel.
    DecibelMilliwatt power{};                ///< In the receivers' channel.
    std::optional<std::uint64_t> version{};  ///< Of the places that `steady_dbm` is for.
    std::vector<double> steady_dbm{};        ///< By node, without what varies from frame to frame.
    std::uint64_t draws{0};
  };

  void follow(Source& source, const Places& places) const;

  const Channel* channel_;
  const Antenna* antenna_;
  std::vector<Decibel> antenna_gains_;
  std::vector<Source> sources_;
  std::vector<double> received_mw_;
};

}  // namespace cuscus::netsim
