#pragma once

#include <cstdint>
#include <vector>

#include "netsim/mac/rate_control.h"

namespace cuscus::netsim {

/// Adaptive auto rate fallback: a rate up after ten acknowledged frames in a row or fifteen
/// attempts, a rate down after two failures in a row, or one right after going up; each failed step
/// up doubles what the next one takes, to at most sixty frames in a row or ninety attempts.
///
/// Source: M. Lacage, M. H. Manshaei, T. Turletti, "IEEE 802.11 rate adaptation: a practical
/// approach", MSWiM 2004.
class AarfRate final : public RateControl {
 public:
  explicit AarfRate(RateSetting setting) : setting_{std::move(setting)} {}

  [[nodiscard]] const Mode& mode(SimTime now, std::uint32_t peer, std::uint32_t attempt) override;
  void report(SimTime now, std::uint32_t peer, const Mode& mode, bool acknowledged) override;
  void heard(std::uint32_t /*peer*/, double /*snr_ratio*/) override {}

 private:
  static constexpr std::uint32_t kLeastSuccesses = 10;
  static constexpr std::uint32_t kMostSuccesses = 60;
  static constexpr std::uint32_t kLeastAttempts = 15;
  static constexpr std::uint32_t kMostAttempts = 90;

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

}  // namespace cuscus::netsim
