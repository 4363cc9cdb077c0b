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
  /// A frame of `peer` has been received with this SINR.
  virtual void heard(std::uint32_t peer, double sinr_ratio) = 0;
};

/// What rate controls have in common.
struct RateSetting {
  std::vector<const Mode*> modes;     ///< To choose from, upwards.
  std::vector<double> required_sinr;  ///< Per mode: bits fail with 10⁻⁶ or less from here on.
  const Mode* first{};                ///< Until something is known of a peer.
  random::CounterStream draws{0, 0};
};

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
  void heard(std::uint32_t /*peer*/, double /*sinr_ratio*/) override {}

 private:
  const Mode* mode_;
};

/// The highest rate whose bits fail with 10⁻⁶ or less at the SINR of the peer's latest frame: the
/// channel is the same in both directions, interference need not be.
class IdealRate final : public RateControl {
 public:
  explicit IdealRate(RateSetting setting) : setting_{std::move(setting)} {}

  [[nodiscard]] const Mode& mode(SimTime now, std::uint32_t peer, std::uint32_t attempt) override;
  void report(SimTime /*now*/, std::uint32_t /*peer*/, const Mode& /*mode*/,
              bool /*acknowledged*/) override {}
  void heard(std::uint32_t peer, double sinr_ratio) override;

 private:
  RateSetting setting_;
  std::vector<double> sinr_;  ///< By peer; 0: never heard.
};

/// Adaptive auto rate fallback: a rate up after ten acknowledged frames in a row or fifteen
/// attempts, a rate down after two failures in a row, or one right after going up; each failed step
/// up doubles what the next one takes, to at most sixty frames.
///
/// Source: M. Lacage, M. H. Manshaei, T. Turletti, "IEEE 802.11 rate adaptation: a practical
/// approach", MSWiM 2004.
class AarfRate final : public RateControl {
 public:
  explicit AarfRate(RateSetting setting) : setting_{std::move(setting)} {}

  [[nodiscard]] const Mode& mode(SimTime now, std::uint32_t peer, std::uint32_t attempt) override;
  void report(SimTime now, std::uint32_t peer, const Mode& mode, bool acknowledged) override;
  void heard(std::uint32_t /*peer*/, double /*sinr_ratio*/) override {}

 private:
  static constexpr std::uint32_t kLeastSuccesses = 10;
  static constexpr std::uint32_t kMostSuccesses = 60;
  static constexpr std::uint32_t kLeastAttempts = 15;

  struct Peer {
    std::size_t rate{0};
    std::uint32_t successes{0};
    std::uint32_t failures{0};
    std::uint32_t attempts{0};  ///< Since the rate last changed.
    std::uint32_t successes_needed{kLeastSuccesses};
    std::uint32_t attempts_needed{kLeastAttempts};
    bool just_raised{false};
    bool known{false};
  };

  Peer& peer(std::uint32_t number);
  void lower(Peer& peer);

  RateSetting setting_;
  std::vector<Peer> peers_;
};

/// Minstrel: what each rate has achieved decides, and every tenth frame tries another.
///
/// Every 100 ms the share of attempts that succeeded enters an average of weight 1/4 per rate. A
/// frame is tried at the rate of the highest throughput, then at the second, then at the most
/// reliable, then at the lowest; one of ten frames at a random rate first, or second where that
/// rate is slower than the best. Throughput counts frames of 1200 B, and nothing where less than
/// one in ten arrives. A rate gets as many attempts as fit into 6 ms, and two where its probability
/// is above 95 % or below 10 %.
///
/// Source: D. Smithies, F. Fietkau, "Minstrel", Linux kernel documentation (mac80211), 2005 to
/// 2010.
class MinstrelRate final : public RateControl {
 public:
  explicit MinstrelRate(RateSetting setting);

  [[nodiscard]] const Mode& mode(SimTime now, std::uint32_t peer, std::uint32_t attempt) override;
  void report(SimTime now, std::uint32_t peer, const Mode& mode, bool acknowledged) override;
  void heard(std::uint32_t /*peer*/, double /*sinr_ratio*/) override {}

 private:
  struct Rate {
    std::uint32_t attempts{0};  ///< In this period.
    std::uint32_t successes{0};
    double probability{0.0};
    bool tried{false};
  };
  struct Peer {
    std::vector<Rate> rates;
    SimTime updated{};
    std::size_t best{0};
    std::size_t second{0};
    std::size_t reliable{0};
    std::uint64_t frames{0};
    std::uint64_t samples{0};
    std::vector<std::size_t> chain;  ///< The rate of each attempt of the frame that is being sent.
  };

  Peer& peer(SimTime now, std::uint32_t number);
  void update(SimTime now, Peer& peer);
  void plan_frame(Peer& peer);
  [[nodiscard]] std::size_t tries(const Peer& peer, std::size_t rate) const;
  [[nodiscard]] double throughput(const Peer& peer, std::size_t rate) const;

  RateSetting setting_;
  std::vector<double> airtimes_s_;  ///< Of 1200 B, per rate.
  std::vector<Peer> peers_;
  std::uint64_t draw_{0};
};

/// The rate control of that name: "constant", "ideal", "aarf" or "minstrel".
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] std::unique_ptr<RateControl> make_rate_control(std::string_view name,
                                                             const RateSetting& setting);

}  // namespace cuscus::netsim
