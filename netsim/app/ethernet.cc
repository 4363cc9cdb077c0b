#include "netsim/app/ethernet.h"

#include "netsim/mac/mac.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {
namespace {

/// Types below are lengths (IEEE Std 802.3, 3.2.6).
constexpr std::uint32_t kFirstType = 0x0600;
// Tags (IEEE Std 802.1Q, table 9-1): behind them comes more than our model of the MAC carries.
constexpr std::uint32_t kCustomerTag = 0x8100;
constexpr std::uint32_t kServiceTag = 0x88a8;
constexpr std::uint32_t kIpv4 = 0x0800;
constexpr std::uint32_t kIpv6 = 0x86dd;

/// RFC 791 and RFC 2474: the second octet of an IPv4 header; RFC 8200: in IPv6 the traffic class
/// begins in the lower half of the first octet.
std::uint8_t priority_of(std::uint32_t type, std::span<const std::uint8_t> packet) {
  if (type == kIpv4 && packet.size() > 1) {
    return static_cast<std::uint8_t>(packet[1] >> 5U);
  }
  if (type == kIpv6 && !packet.empty()) {
    return static_cast<std::uint8_t>((packet[0] >> 1U) & 7U);
  }
  return 0;
}

}  // namespace

std::optional<EthernetHead> parse_ethernet(std::span<const std::uint8_t> head,
                                           std::uint32_t frame_bytes) {
  if (frame_bytes < kEthernetHeaderBytes || head.size() < kEthernetHeaderBytes ||
      frame_bytes - kEthernetHeaderBytes + kLlcSnapBytes > kMaximumMsduBytes) {
    return std::nullopt;
  }
  const std::uint32_t type = (std::uint32_t{head[12]} << 8U) | head[13];
  if (type < kFirstType || type == kCustomerTag || type == kServiceTag) {
    return std::nullopt;
  }
  return EthernetHead{.destination = mac_address(head.first<6>()),
                      .group = (head[0] & 1U) != 0,
                      .priority = priority_of(type, head.subspan(kEthernetHeaderBytes))};
}

std::uint64_t mac_address(std::span<const std::uint8_t, 6> octets) {
  std::uint64_t address = 0;
  for (const std::uint8_t octet : octets) {
    address = (address << 8U) | octet;
  }
  return address;
}

std::int32_t AddressBook::destination(const EthernetHead& head) const {
  if (head.group) {
    return kGroup;
  }
  const auto found = nodes_.find(head.destination);
  return found == nodes_.end() ? kNobody : static_cast<std::int32_t>(found->second);
}

}  // namespace cuscus::netsim
