#pragma once

#include <cstdint>
#include <vector>

#include "netsim/mac/rate_control.h"

namespace cuscus::netsim {

/// Minstrel: what each rate has achieved decides, and every tenth frame tries another.
///
/// Every 100 ms the share of attempts that succeeded enters an average of weight 1/4 per rate. A
/// frame is tried at the rate of the highest throughput, then at the second, then at the most
/// reliable, then at the lowest; one of ten frames at a random rate first, or second where that
/// rate is slower than the best. Throughput counts frames of 1200 B, and nothing where less than
/// one in ten arrives. A rate gets as many attempts as fit into 6 ms, two where its probability is
/// above 95 % or below 10 %, and never more than a third of those that the retry limit allows
/// before the last: every frame that fails comes to the lowest rate.
///
/// Source: D. Smithies, F. Fietkau, "Minstrel", Linux kernel documentation (mac80211), 2005 to
/// 2010. Departs from it in the last clause: there the attempts at all rates add up, and no retry
/// limit of 802.11 ends a frame before.
class MinstrelRate final : public RateControl {
 public:
  explicit MinstrelRate(RateSetting setting);

  [[nodiscard]] const Mode& mode(SimTime now, std::uint32_t peer, std::uint32_t attempt) override;
  void report(SimTime now, std::uint32_t peer, const Mode& mode, bool acknowledged) override;
  void heard(std::uint32_t /*peer*/, double /*snr_ratio*/) override {}

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

}  // namespace cuscus::netsim
