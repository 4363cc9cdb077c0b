#include "ground-station/core/sequence_tally.h"

#include <algorithm>
#include <bit>

namespace cuscus::gcs {

SequenceTally::Arrival SequenceTally::count(std::uint32_t sequence, SimTime at) noexcept {
  const auto ahead = static_cast<std::int32_t>(sequence - newest_);
  const bool anew = ahead <= 0 && (at > newest_at_ || ahead <= -static_cast<std::int32_t>(kWindow));
  if (expected_ == 0 || anew) {
    restart(sequence);
    newest_at_ = at;
    return Arrival::kNewest;
  }
  if (ahead > 0) {
    newest_at_ = at;
    const auto steps = static_cast<std::uint32_t>(ahead);
    window_ = steps >= kWindow ? 0 : window_ << steps;
    window_ |= 1U;
    newest_ = sequence;
    expected_ += steps;
    ++received_;
    return Arrival::kNewest;
  }
  const auto back = static_cast<std::uint32_t>(-ahead);
  const std::uint64_t bit = std::uint64_t{1} << back;
  if ((window_ & bit) != 0) {
    return Arrival::kDuplicate;
  }
  window_ |= bit;
  ++received_;
  expected_ = std::max<std::uint64_t>(expected_, std::uint64_t{back} + 1);
  return Arrival::kLate;
}

void SequenceTally::restart(std::uint32_t sequence) noexcept {
  newest_ = sequence;
  window_ = 1;
  received_ = 1;
  expected_ = 1;
}

double SequenceTally::loss_ratio() const noexcept {
  if (expected_ == 0) {
    return 0.0;
  }
  return 1.0 - static_cast<double>(received_) / static_cast<double>(expected_);
}

double SequenceTally::recent_loss_ratio() const noexcept {
  if (expected_ == 0) {
    return 0.0;
  }
  const auto looked_at = std::min<std::uint64_t>(expected_, kWindow);
  const std::uint64_t mask = ~std::uint64_t{0} >> (kWindow - looked_at);
  return 1.0 - static_cast<double>(std::popcount(window_ & mask)) / static_cast<double>(looked_at);
}

}  // namespace cuscus::gcs
