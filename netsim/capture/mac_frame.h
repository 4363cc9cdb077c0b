#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// BSSID of frames outside the context of a BSS, as 802.11p sends them [IEEE Std 802.11-2016,
/// 9.2.4.3.4].
inline constexpr std::uint64_t kWildcardBssid = 0xffff'ffff'ffff;
/// BSSID of every cuscus run: individual and locally administered, as that of an IBSS must be.
inline constexpr std::uint64_t kIbssBssid = 0x02'63'75'73'ff'ff;

/// The CRC-32 that ends every frame [9.2.4.8].
[[nodiscard]] std::uint32_t frame_check_sequence(std::span<const std::uint8_t> octets);

struct DataFrame {
  std::span<const std::uint8_t> ethernet;  ///< Ethernet II, without FCS; at least its header.
  std::uint64_t bssid{kIbssBssid};
  std::uint32_t sequence{};  ///< Modulo 4096 on the air.
  bool retry{};
  Duration duration{};
};

enum class ControlKind : std::uint8_t { kAck, kRts, kCts };

struct ControlFrame {
  ControlKind kind{};
  std::uint64_t receiver{};     ///< RA
  std::uint64_t transmitter{};  ///< TA; RTS only.
  Duration duration{};
};

// MPDUs as they are on the air [9.3], FCS included. The Duration field is in microseconds, rounded
// up [9.2.5.1].

/// A data frame between stations without an access point (To DS and From DS are 0): destination,
/// source, BSSID; the Ethernet type behind LLC and SNAP as RFC 1042 has it.
void append_data_frame(std::vector<std::uint8_t>& octets, const DataFrame& frame);
void append_control_frame(std::vector<std::uint8_t>& octets, const ControlFrame& frame);

}  // namespace cuscus::netsim
