#pragma once

#include <cstdint>
#include <optional>

namespace cuscus::world {

/// When a sensor is read: reading k at the first step at or after k periods.
struct Schedule {
  std::int64_t period_ns{0};  ///< 0: never.
  std::uint64_t next{0};

  /// The number of the reading that is due by `now_ns`, once.
  [[nodiscard]] std::optional<std::uint64_t> due(std::int64_t now_ns) {
    if (period_ns == 0 || now_ns / period_ns < static_cast<std::int64_t>(next)) {
      return std::nullopt;
    }
    return next++;
  }
};

}  // namespace cuscus::world
