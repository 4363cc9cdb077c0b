#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>

namespace cuscus::shm {

/// Thrown on attaching to memory that is not what the reader expects.
struct LayoutError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Coherence granule of the machines we run on: one writer per line.
inline constexpr std::size_t kCacheLine = 64;

/// First bytes of every shared memory: what it is, so that a process of another build refuses it.
struct alignas(kCacheLine) Header {
  std::uint64_t magic;       ///< Which memory, as eight ASCII characters.
  std::uint32_t version;     ///< Of its layout; any change of a struct raises it.
  std::uint32_t node_count;  ///< Slots that follow, 0 where there are none.
  std::uint64_t byte_size;   ///< Of the whole.
};

/// "CUSFLEET" as a number whose bytes read so in memory (little-endian).
[[nodiscard]] constexpr std::uint64_t magic_of(std::string_view eight_characters) {
  std::uint64_t magic = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    magic |= static_cast<std::uint64_t>(static_cast<unsigned char>(eight_characters.at(i)))
             << (8 * i);
  }
  return magic;
}

/// Writes `header` at the start of `memory`, which must be as large as it says.
void write_header(std::span<std::byte> memory, const Header& header);

/// Checks magic, version and size, and returns the header.
/// @throws LayoutError naming what was expected and what was found.
Header checked_header(std::span<const std::byte> memory, std::uint64_t magic,
                      std::uint32_t version);

}  // namespace cuscus::shm
