#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

using Duration = SimClock::duration;

enum class Modulation : std::uint8_t { kBpsk, kQpsk, k16Qam, k64Qam };
enum class CodeRate : std::uint8_t { kHalf, kTwoThirds, kThreeQuarters };

/// How a PPDU of one kind is laid out in time. All numbers of one row of a standard.
struct PpduFormat {
  Duration preamble;   ///< Training symbols; carries no bits.
  Duration header;     ///< SIGNAL field, or PLCP header.
  double header_bits;  ///< Bits in it that must all be right.
  Modulation header_modulation;
  CodeRate header_code_rate;
  Duration symbol;
  std::uint32_t service_bits;
  std::uint32_t tail_bits;
  Duration extension;  ///< Signal extension: silence that belongs to the PPDU.
};

/// One rate.
struct Mode {
  std::uint32_t rate_kbps;
  Modulation modulation;
  CodeRate code_rate;
  std::uint32_t bits_per_symbol;  ///< N_DBPS.
  bool mandatory;
  const PpduFormat* format;
};

/// A physical layer, as data: 802.11a, 802.11p or DSSS are further rows and no further code.
struct Standard {
  std::string_view name;
  double bandwidth_hz;
  Duration slot;  ///< Default; a scenario may say another.
  Duration sifs;
  Duration cca_time;             ///< A signal makes the medium busy this long after its arrival.
  Duration receive_start_delay;  ///< aRxPHYStartDelay: arrival to PHY-RXSTART.
  std::uint32_t cw_min;
  std::uint32_t cw_max;
  std::span<const Mode> modes;

  /// @throws std::invalid_argument naming the rates that are allowed.
  [[nodiscard]] const Mode& mode(std::uint32_t rate_kbps) const;
};

/// 802.11g, ERP-OFDM rates (IEEE Std 802.11-2016, clauses 17 and 18). The slot is 20 us, as in any
/// independent BSS; ERP stations add a signal extension of 6 us to every OFDM PPDU (18.3.2.4).
[[nodiscard]] const Standard& ieee80211g();

/// The standard of that name.
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] const Standard& standard_of(std::string_view name);

/// Time on air of a PPDU [17.4.3]:
///
///   T = preamble + header + symbol · ⌈(service + 8 · PSDU + tail) / N_DBPS⌉ + extension.
[[nodiscard]] Duration airtime(const Mode& mode, std::uint32_t psdu_bytes);

/// Rate of the control answer to a frame received at `received` [10.7.6.5.2]: the highest basic
/// rate of the same class of modulation that is not above it; where there is none, the highest
/// mandatory rate not above it.
[[nodiscard]] const Mode& control_answer(const Standard& standard, const Mode& received,
                                         std::span<const std::uint32_t> basic_rates_kbps);

/// Sizes of what surrounds a payload [B].
inline constexpr std::uint32_t kDataHeaderBytes = 24;  ///< MAC header of a non-QoS data frame.
inline constexpr std::uint32_t kLlcSnapBytes = 8;
inline constexpr std::uint32_t kFcsBytes = 4;
inline constexpr std::uint32_t kAckBytes = 14;
inline constexpr std::uint32_t kEthernetHeaderBytes = 14;
inline constexpr std::uint32_t kMaximumMsduBytes = 2304;  ///< LLC/SNAP included.

/// PSDU of an Ethernet II frame (without FCS) that crosses the air: 14 B of Ethernet header become
/// a MAC header, LLC/SNAP and FCS.
[[nodiscard]] constexpr std::uint32_t psdu_bytes_of_ethernet(std::uint32_t frame_bytes) {
  return frame_bytes - kEthernetHeaderBytes + kLlcSnapBytes + kDataHeaderBytes + kFcsBytes;
}

}  // namespace cuscus::netsim
