#pragma once

#include <cstdint>

namespace cuscus::posix {

/// CPU time of the calling process, all its threads, user and system [s].
[[nodiscard]] double process_cpu_s() noexcept;

/// Resident set of the calling process [B]; 0 when /proc is not there.
[[nodiscard]] std::uint64_t resident_bytes() noexcept;

}  // namespace cuscus::posix
