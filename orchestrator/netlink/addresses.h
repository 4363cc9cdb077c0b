#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace cuscus::netlink {

/// An Ethernet address, in the order of its bytes on the air.
using MacAddress = std::array<std::uint8_t, 6>;

/// An IPv4 address, in the order of its bytes on the air.
using Ipv4Address = std::array<std::uint8_t, 4>;

/// An address and the network it is in, such as 10.0.0.3/16.
struct Ipv4Prefix {
  Ipv4Address address{};
  std::uint8_t length{24};  ///< Leading bits that the network shares, at most 32.
};

/// Who answers at an address, for networks that do without ARP.
struct Neighbour {
  Ipv4Address address{};
  MacAddress mac{};
};

/// The network's broadcast address: the host part all ones.
[[nodiscard]] constexpr Ipv4Address broadcast_of(const Ipv4Prefix& prefix) noexcept {
  Ipv4Address broadcast = prefix.address;
  for (unsigned bit = prefix.length; bit < 32; ++bit) {
    broadcast[bit / 8] = static_cast<std::uint8_t>(broadcast[bit / 8] | (0x80U >> (bit % 8)));
  }
  return broadcast;
}

/// "10.0.0.3"
[[nodiscard]] inline std::string to_string(const Ipv4Address& address) {
  std::string text;
  for (const std::uint8_t byte : address) {
    text += (text.empty() ? "" : ".") + std::to_string(byte);
  }
  return text;
}

}  // namespace cuscus::netlink
