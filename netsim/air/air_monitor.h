#pragma once

#include <cstdint>
#include <vector>

#include "netsim/mac/mac.h"
#include "netsim/phy/receiver.h"

namespace cuscus::netsim {

/// What a station puts on the air at once.
struct Ppdu {
  MacFrame frame;
  const Mode* mode{};
  std::uint32_t psdu_bytes{};
  std::uint32_t attempt{};   ///< Of its data frame, from 1; 0 for an RTS before the first.
  std::uint64_t number{};    ///< The sender's how-manieth, from 0.
  std::uint64_t offer_id{};  ///< OfferedFrame::id; data and RTS only.
  SimTime begins{};
  SimTime ends{};  ///< With the signal extension.
  /// PositionSource::version() of where everybody was when it began.
  std::uint64_t positions_version{};
};

/// How a PPDU came out at one node.
struct Reception {
  std::uint32_t receiver{};
  SimTime time{};  ///< When it was over there.
  LossCause cause{LossCause::kNone};
  DecibelMilliwatt power{};
  /// The worst while it was received, or when its preamble was not detected. Meaningless with
  /// LossCause::kHalfDuplex; on an ideal air, which has none, not a number.
  Decibel sinr{};
  /// Sender of the strongest other frame heard meanwhile, or of the one that the receiver was with;
  /// kNoSender when there was none.
  std::uint32_t interferer{kNoSender};
};

/// Whoever wants to know of every PPDU. A node at which it arrives below the floor
/// (AirParameters::arrival_floor_below_noise) has no Reception, but is named to unreached() when a
/// data frame or RTS was meant for it. Must not call the air.
class AirMonitor {
 public:
  virtual ~AirMonitor() = default;
  virtual void transmitted(const Ppdu& ppdu) = 0;
  virtual void received(const Ppdu& ppdu, const Reception& reception) = 0;
  /// Told after transmitted(), while it begins.
  virtual void unreached(const Ppdu& /*ppdu*/, std::uint32_t /*receiver*/) {}
};

/// Several of them, told in the order in which they were added.
class AirMonitors final : public AirMonitor {
 public:
  /// `monitor` must outlive this object.
  void add(AirMonitor& monitor) { monitors_.push_back(&monitor); }

  void transmitted(const Ppdu& ppdu) override {
    for (AirMonitor* const monitor : monitors_) {
      monitor->transmitted(ppdu);
    }
  }
  void received(const Ppdu& ppdu, const Reception& reception) override {
    for (AirMonitor* const monitor : monitors_) {
      monitor->received(ppdu, reception);
    }
  }
  void unreached(const Ppdu& ppdu, std::uint32_t receiver) override {
    for (AirMonitor* const monitor : monitors_) {
      monitor->unreached(ppdu, receiver);
    }
  }

 private:
  std::vector<AirMonitor*> monitors_;
};

}  // namespace cuscus::netsim
