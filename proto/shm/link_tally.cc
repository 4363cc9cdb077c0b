#include "proto/shm/link_tally.h"

#include <algorithm>

namespace cuscus::shm {
namespace {

constexpr unsigned kLowestAt = 16;
constexpr unsigned kHighestAt = 32;

constexpr std::uint64_t field(std::uint64_t rates, unsigned at) { return (rates >> at) & 0xffffU; }

}  // namespace

void LinkTallySlot::note_rate(std::uint32_t rate_kbps) noexcept {
  const std::uint64_t latest = rate_kbps / kRateUnit_kbps;
  const std::uint64_t before = rates_.load(std::memory_order_relaxed);
  const std::uint64_t lowest = before == 0 ? latest : std::min(latest, field(before, kLowestAt));
  const std::uint64_t highest = std::max(latest, field(before, kHighestAt));
  rates_.store(latest | lowest << kLowestAt | highest << kHighestAt, std::memory_order_relaxed);
}

LinkTally LinkTallySlot::load() const noexcept {
  LinkTally tally;
  for (std::size_t i = 0; i < kLinkCounts; ++i) {
    tally.counts[i] = counts_[i].load(std::memory_order_relaxed);
  }
  const std::uint64_t rates = rates_.load(std::memory_order_relaxed);
  const auto rate_kbps = [&](unsigned at) {
    return static_cast<std::uint32_t>(field(rates, at)) * kRateUnit_kbps;
  };
  tally.rates = {.latest_kbps = rate_kbps(0),
                 .lowest_kbps = rate_kbps(kLowestAt),
                 .highest_kbps = rate_kbps(kHighestAt)};
  return tally;
}

}  // namespace cuscus::shm
