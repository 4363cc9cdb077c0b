#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// Blocks of the PCAP Next Generation capture file format (IETF draft-ietf-opsawg-pcapng), in
/// little-endian, with nanoseconds.
namespace cuscus::netsim::pcapng {

/// LINKTYPE_IEEE802_11_RADIOTAP: a radiotap header before every frame.
inline constexpr std::uint16_t kRadiotapLink = 127;

/// Begins a file.
void append_section_header(std::vector<std::uint8_t>& octets, std::string_view application);

struct Interface {
  std::uint16_t link_type{kRadiotapLink};
  std::string_view name;
  std::string_view description;
  std::uint32_t snap_length{};  ///< 0: frames are whole.
};
void append_interface(std::vector<std::uint8_t>& octets, const Interface& interface);

struct Packet {
  std::uint64_t time_ns{};  ///< Since 1970.
  std::span<const std::uint8_t> octets;
  std::uint32_t original_bytes{};  ///< Before the snap length cut it.
  bool outbound{};
  std::string_view comment;  ///< Empty: none.
};
/// Of the file's only interface.
void append_packet(std::vector<std::uint8_t>& octets, const Packet& packet);

struct Statistics {
  std::uint64_t time_ns{};
  std::uint64_t captured{};
  std::uint64_t dropped{};  ///< Should be in the file, and are not.
};
void append_statistics(std::vector<std::uint8_t>& octets, const Statistics& statistics);

}  // namespace cuscus::netsim::pcapng
