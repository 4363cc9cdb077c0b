#pragma once

#include <cstdint>

namespace cuscus::posix {

/// CLOCK_MONOTONIC now [ns].
[[nodiscard]] std::int64_t monotonic_now_ns() noexcept;

/// CLOCK_REALTIME now [ns since 1970].
[[nodiscard]] std::int64_t realtime_now_ns() noexcept;

/// Sleeps until CLOCK_MONOTONIC reaches `deadline_ns`; returns at once when it has passed. Late by
/// 20 us and more on a good day: what must be exact spins for the rest.
void sleep_until_monotonic(std::int64_t deadline_ns) noexcept;

}  // namespace cuscus::posix
