#pragma once

#include <cstdint>

namespace cuscus::posix {

/// Raises the soft limit of open files (RLIMIT_NOFILE) to at least `needed`, and the hard one where
/// that is allowed. Returns the soft limit after it, which may be less than asked for.
std::uint64_t raise_open_file_limit(std::uint64_t needed);

/// The most that raise_open_file_limit() could give without rights: the hard limit.
[[nodiscard]] std::uint64_t hard_open_file_limit();

}  // namespace cuscus::posix
