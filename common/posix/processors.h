#pragma once

#include <span>
#include <string>
#include <vector>

namespace cuscus::posix {

/// The processors on which the calling thread may run, in ascending order.
[[nodiscard]] std::vector<int> allowed_processors();

/// Keeps the calling thread on one processor from now on; false when the kernel refuses.
bool try_pin(int processor) noexcept;

/// A set of processors as the kernel's files have it: 32-bit groups of hexadecimal digits, the
/// highest first, with commas between them.
[[nodiscard]] std::string processor_mask(std::span<const int> processors);

}  // namespace cuscus::posix
