#include "netsim/capture/pcapng.h"

#include "netsim/capture/octet_writer.h"

namespace cuscus::netsim::pcapng {
namespace {

constexpr std::uint32_t kSectionHeader = 0x0a0d'0d0a;
constexpr std::uint32_t kInterfaceDescription = 1;
constexpr std::uint32_t kInterfaceStatistics = 5;
constexpr std::uint32_t kEnhancedPacket = 6;

constexpr std::uint16_t kEndOfOptions = 0;
constexpr std::uint16_t kComment = 1;
constexpr std::uint16_t kUserApplication = 4;
constexpr std::uint16_t kInterfaceName = 2;
constexpr std::uint16_t kInterfaceText = 3;
constexpr std::uint16_t kTimeResolution = 9;
constexpr std::uint16_t kPacketFlags = 2;
constexpr std::uint16_t kStatisticsReceived = 4;
constexpr std::uint16_t kStatisticsDropped = 5;

constexpr std::size_t kAlignment = 4;

/// A block between its two lengths.
class Block {
 public:
  Block(std::vector<std::uint8_t>& octets, std::uint32_t type)
      : out{octets}, begin_{out.position()} {
    out.u32(type);
    out.u32(0);  // the length, once it is known
  }
  void end() {
    const auto length = static_cast<std::uint32_t>(out.position() - begin_ + sizeof(std::uint32_t));
    out.u32(length);
    out.replace_u32(begin_ + sizeof(std::uint32_t), length);
  }

  void option(std::uint16_t code, std::string_view text) {
    option_head(code, text.size());
    out.text(text);
    out.pad(begin_, kAlignment);
  }
  void option_u8(std::uint16_t code, std::uint8_t value) {
    option_head(code, sizeof value);
    out.u8(value);
    out.pad(begin_, kAlignment);
  }
  void option_u32(std::uint16_t code, std::uint32_t value) {
    option_head(code, sizeof value);
    out.u32(value);
  }
  void option_u64(std::uint16_t code, std::uint64_t value) {
    option_head(code, sizeof value);
    out.u64(value);
  }
  void end_of_options() { option_head(kEndOfOptions, 0); }

  /// Nanoseconds, the upper half first.
  void time(std::uint64_t time_ns) {
    out.u32(static_cast<std::uint32_t>(time_ns >> 32U));
    out.u32(static_cast<std::uint32_t>(time_ns));
  }
  void pad() { out.pad(begin_, kAlignment); }

  OctetWriter out;

 private:
  void option_head(std::uint16_t code, std::size_t bytes) {
    out.u16(code);
    out.u16(static_cast<std::uint16_t>(bytes));
  }

  std::size_t begin_;
};

}  // namespace

void append_section_header(std::vector<std::uint8_t>& octets, std::string_view application) {
  constexpr std::uint32_t kByteOrder = 0x1a2b'3c4d;
  constexpr std::uint16_t kMajorVersion = 1;
  constexpr std::uint16_t kMinorVersion = 0;
  constexpr std::uint64_t kUnknownLength = ~std::uint64_t{0};
  Block block{octets, kSectionHeader};
  block.out.u32(kByteOrder);
  block.out.u16(kMajorVersion);
  block.out.u16(kMinorVersion);
  block.out.u64(kUnknownLength);
  block.option(kUserApplication, application);
  block.end_of_options();
  block.end();
}

void append_interface(std::vector<std::uint8_t>& octets, const Interface& interface) {
  constexpr std::uint8_t kNanoseconds = 9;  // 10^-9 s
  Block block{octets, kInterfaceDescription};
  block.out.u16(interface.link_type);
  block.out.u16(0);  // reserved
  block.out.u32(interface.snap_length);
  block.option(kInterfaceName, interface.name);
  block.option(kInterfaceText, interface.description);
  block.option_u8(kTimeResolution, kNanoseconds);
  block.end_of_options();
  block.end();
}

void append_packet(std::vector<std::uint8_t>& octets, const Packet& packet) {
  constexpr std::uint32_t kInbound = 1;
  constexpr std::uint32_t kOutbound = 2;
  Block block{octets, kEnhancedPacket};
  block.out.u32(0);  // the interface's number
  block.time(packet.time_ns);
  block.out.u32(static_cast<std::uint32_t>(packet.octets.size()));
  block.out.u32(packet.original_bytes);
  block.out.octets(packet.octets);
  block.pad();
  block.option_u32(kPacketFlags, packet.outbound ? kOutbound : kInbound);
  if (!packet.comment.empty()) {
    block.option(kComment, packet.comment);
  }
  block.end_of_options();
  block.end();
}

void append_statistics(std::vector<std::uint8_t>& octets, const Statistics& statistics) {
  Block block{octets, kInterfaceStatistics};
  block.out.u32(0);  // the interface's number
  block.time(statistics.time_ns);
  block.option_u64(kStatisticsReceived, statistics.captured + statistics.dropped);
  block.option_u64(kStatisticsDropped, statistics.dropped);
  block.end_of_options();
  block.end();
}

}  // namespace cuscus::netsim::pcapng
