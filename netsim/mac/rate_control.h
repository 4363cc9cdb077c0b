#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "common/random/counter_stream.h"
#include "netsim/phy/error_model.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// At what rate a station sends individually addressed frames; one per station. Group frames and
/// control frames have fixed rates.
class RateControl {
 public:
  virtual ~RateControl() = default;

  /// For the `attempt`-th attempt, from 0, of a frame to `peer`.
  [[nodiscard]] virtual const Mode& mode(SimTime now, std::uint32_t peer,
                                         std::uint32_t attempt) = 0;
  /// What became of an attempt at that rate.
  virtual void report(SimTime now, std::uint32_t peer, const Mode& mode, bool acknowledged) = 0;
  /// A frame of `peer` has been received with this ratio of signal to noise, interference aside.
  virtual void heard(std::uint32_t peer, double snr_ratio) = 0;
};

/// What rate controls have in common.
struct RateSetting {
  std::vector<const Mode*> modes;    ///< To choose from, upwards.
  std::vector<double> required_snr;  ///< Per mode: bits fail with 10⁻⁶ or less from here on.
  const Mode* first{};               ///< Until something is known of a peer.
  std::uint32_t attempts{7};         ///< That the retry limit allows a frame.
  random::CounterStream draws{0, 0};
};

/// Entry `number` of what a rate control knows by peer; the table grows with the peers met.
template <typename Peer>
[[nodiscard]] Peer& grown_to(std::vector<Peer>& peers, std::uint32_t number) {
  if (peers.size() <= number) {
    peers.resize(number + std::size_t{1});
  }
  return peers[number];
}

/// Place of `mode` in `setting.modes`.
[[nodiscard]] std::size_t index_of(const RateSetting& setting, const Mode& mode);

/// Modes of the class of `first`, and what they require under `errors`.
[[nodiscard]] RateSetting rate_setting(const Standard& standard, const Mode& first,
                                       const ErrorModel& errors);

/// Always the same rate.
class ConstantRate final : public RateControl {
 public:
  explicit ConstantRate(const RateSetting& setting) : mode_{setting.first} {}

  [[nodiscard]] const Mode& mode(SimTime /*now*/, std::uint32_t /*peer*/,
                                 std::uint32_t /*attempt*/) override {
    return *mode_;
  }
  void report(SimTime /*now*/, std::uint32_t /*peer*/, const Mode& /*mode*/,
              bool /*acknowledged*/) override {}
  void heard(std::uint32_t /*peer*/, double /*snr_ratio*/) override {}

 private:
  const Mode* mode_;
};

/// The highest rate whose bits fail with 10⁻⁶ or less at the SNR of the peer's latest frame: the
/// channel is the same in both directions, interference need not be.
class IdealRate final : public RateControl {
 public:
  explicit IdealRate(RateSetting setting) : setting_{std::move(setting)} {}

  [[nodiscard]] const Mode& mode(SimTime now, std::uint32_t peer, std::uint32_t attempt) override;
  void report(SimTime /*now*/, std::uint32_t /*peer*/, const Mode& /*mode*/,
              bool /*acknowledged*/) override {}
  void heard(std::uint32_t peer, double snr_ratio) override;

 private:
  RateSetting setting_;
  std::vector<double> snr_;  ///< By peer; 0: never heard.
};

/// The rate control of that name: "constant", "ideal", "aarf" or "minstrel".
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] std::unique_ptr<RateControl> make_rate_control(std::string_view name,
                                                             const RateSetting& setting);

}  // namespace cuscus::netsim
