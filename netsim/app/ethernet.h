#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>

namespace cuscus::netsim {

/// What the MAC must know of an Ethernet frame.
struct EthernetHead {
  std::uint64_t destination;  ///< 48 bits, the first octet highest.
  bool group;                 ///< Broadcast or multicast.
  std::uint8_t priority{};    ///< 802.1D user priority, 0 ... 7.
};

/// Reads the head of an Ethernet II frame of `frame_bytes` in all, without FCS. Nothing when it
/// cannot cross the air: shorter than its header, longer than an MSDU may be, with an IEEE 802.3
/// length where the type should be, or with a VLAN tag. The source address is not looked at: a
/// radio is known by its interface. The priority is that of the three highest bits of an IP
/// packet's DSCP, as Linux gives it to frames of 802.11 (cfg80211_classify8021d()); 0 for others.
[[nodiscard]] std::optional<EthernetHead> parse_ethernet(std::span<const std::uint8_t> head,
                                                         std::uint32_t frame_bytes);

/// 48-bit address of six octets.
[[nodiscard]] std::uint64_t mac_address(std::span<const std::uint8_t, 6> octets);

/// Which node has an address.
class AddressBook {
 public:
  /// False when the address is taken.
  bool add(std::uint64_t address, std::uint32_t node) {
    return nodes_.emplace(address, node).second;
  }
  /// A node, kGroup or kNobody.
  [[nodiscard]] std::int32_t destination(const EthernetHead& head) const;

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> nodes_;
};

}  // namespace cuscus::netsim
