#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace cuscus::posix {

/// Linux capabilities (capabilities(7)), bit n for capability number n.
using CapabilityMask = std::uint64_t;

/// The mask of names such as "cap_net_raw".
/// @throws std::invalid_argument naming the one that the system does not know.
[[nodiscard]] CapabilityMask capability_mask(std::span<const std::string> names);

/// The one bit of a CAP_... number.
[[nodiscard]] constexpr CapabilityMask capability_bit(int number) noexcept {
  return CapabilityMask{1} << static_cast<unsigned>(number);
}

/// What the calling thread may use now, in its own user namespace.
[[nodiscard]] CapabilityMask effective_capabilities() noexcept;

/// Whether the calling thread may use capability `number`.
[[nodiscard]] inline bool has_capability(int number) noexcept {
  return (effective_capabilities() & capability_bit(number)) != 0;
}

}  // namespace cuscus::posix
