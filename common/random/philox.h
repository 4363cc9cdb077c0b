#pragma once

#include <array>
#include <cstdint>

namespace cuscus::random {

/// The block function Philox4x32-10: 128 pseudo-random bits for each (counter, key).
///
/// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as
/// 1, 2, 3", SC 2011, section 3.3. Checked against the known answers published with it.
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                      std::array<std::uint32_t, 2> key) noexcept;

}  // namespace cuscus::random
