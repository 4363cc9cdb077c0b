#include "netsim/capture/mac_frame.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "netsim/capture/octet_writer.h"

namespace cuscus::netsim {
namespace {

// Frame Control, as a little-endian number: type in bits 2-3, subtype in bits 4-7, Retry in bit 11
// [9.2.4.1].
constexpr std::uint16_t kData = 0x0008;
constexpr std::uint16_t kRts = 0x00b4;
constexpr std::uint16_t kCts = 0x00c4;
constexpr std::uint16_t kAck = 0x00d4;
constexpr std::uint16_t kRetry = 0x0800;

constexpr std::size_t kAddressBytes = 6;
constexpr std::size_t kEthernetTypeOffset = 2 * kAddressBytes;

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  // x^32 + x^26 + x^23 + ... + 1 with the lowest power in the highest bit.
  constexpr std::uint32_t kPolynomial = 0xedb8'8320;
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t octet = 0; octet < table.size(); ++octet) {
    std::uint32_t remainder = octet;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1U) ^ ((remainder & 1U) != 0 ? kPolynomial : 0);
    }
    table.at(octet) = remainder;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

std::uint16_t duration_field(Duration duration) {
  constexpr std::int64_t kMost_us = 32'767;
  const auto whole_us = std::chrono::ceil<std::chrono::microseconds>(duration).count();
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>(whole_us, 0, kMost_us));
}

void append_fcs(std::vector<std::uint8_t>& octets, std::size_t begin) {
  OctetWriter{octets}.u32(frame_check_sequence(std::span{octets}.subspan(begin)));
}

}  // namespace

std::uint32_t frame_check_sequence(std::span<const std::uint8_t> octets) {
  std::uint32_t remainder = 0xffff'ffff;
  for (const std::uint8_t octet : octets) {
    remainder = (remainder >> 8U) ^ kCrcTable[(remainder ^ octet) & 0xffU];
  }
  return ~remainder;
}

void append_data_frame(std::vector<std::uint8_t>& octets, const DataFrame& frame) {
  // LLC: SNAP in both access points, unnumbered information; SNAP: the organization of RFC 1042.
  constexpr std::array<std::uint8_t, 6> kLlcSnap{0xaa, 0xaa, 0x03, 0x00, 0x00, 0x00};
  constexpr unsigned kSequenceShift = 4;  // below it, the number of the fragment
  OctetWriter out{octets};
  const std::size_t begin = out.position();
  out.u16(frame.retry ? kData | kRetry : kData);
  out.u16(duration_field(frame.duration));
  out.octets(frame.ethernet.first(2 * kAddressBytes));
  out.mac_address(frame.bssid);
  out.u16(static_cast<std::uint16_t>(frame.sequence << kSequenceShift));
  out.octets(kLlcSnap);
  out.octets(frame.ethernet.subspan(kEthernetTypeOffset));
  append_fcs(octets, begin);
}

void append_control_frame(std::vector<std::uint8_t>& octets, const ControlFrame& frame) {
  OctetWriter out{octets};
  const std::size_t begin = out.position();
  const bool rts = frame.kind == ControlKind::kRts;
  out.u16(rts ? kRts : frame.kind == ControlKind::kCts ? kCts : kAck);
  out.u16(duration_field(frame.duration));
  out.mac_address(frame.receiver);
  if (rts) {
    out.mac_address(frame.transmitter);
  }
  append_fcs(octets, begin);
}

}  // namespace cuscus::netsim
