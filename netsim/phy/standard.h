#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

using Duration = SimClock::duration;

enum class Modulation : std::uint8_t {
  kBpsk,
  kQpsk,
  k16Qam,
  k64Qam,
  kDbpsk,    ///< Barker-spread, 1 Mb/s.
  kDqpsk,    ///< Barker-spread, 2 Mb/s.
  kCck4Bit,  ///< Complementary code keying, 5.5 Mb/s: 4 bits per code word.
  kCck8Bit   ///< The same, 11 Mb/s: 8 bits per code word.
};
inline constexpr std::size_t kModulations = 8;

enum class CodeRate : std::uint8_t { kHalf, kTwoThirds, kThreeQuarters, kUncoded };
inline constexpr std::size_t kCodeRates = 4;

/// How a PPDU of one kind is laid out in time. All numbers of one row of a standard.
struct PpduFormat {
  Duration preamble;   ///< Training symbols; carries no bits.
  Duration header;     ///< SIGNAL field, or PLCP header.
  double header_bits;  ///< Bits in it that must all be right.
  Modulation header_modulation;
  CodeRate header_code_rate;
  Duration symbol;  ///< The payload is a whole number of these.
  std::uint32_t service_bits;
  std::uint32_t tail_bits;
  Duration extension;            ///< Signal extension: silence that belongs to the PPDU.
  Duration receive_start_delay;  ///< aRxPHYStartDelay: arrival to PHY-RXSTART.
};

/// Which rates understand one another's control frames.
enum class ModulationClass : std::uint8_t { kDsss, kOfdm };

/// One rate.
struct Mode {
  std::uint32_t rate_kbps;
  Modulation modulation;
  CodeRate code_rate;
  bool mandatory;
  ModulationClass modulation_class;
  const PpduFormat* format;
};

/// Length of the preamble of DSSS and CCK frames. At 1 Mb/s it is always long.
enum class DsssPreamble : std::uint8_t { kLong, kShort };

/// A physical layer, as data.
struct Standard {
  std::string_view name;
  double bandwidth_hz;
  Duration slot;  ///< Default; a scenario may say another.
  Duration sifs;
  Duration cca_time;  ///< A signal makes the medium busy this long after its arrival.
  std::uint32_t cw_min;
  std::uint32_t cw_max;
  std::span<const Mode> modes;  ///< By rate.

  /// @throws std::invalid_argument naming the rates that are allowed.
  [[nodiscard]] const Mode& mode(std::uint32_t rate_kbps) const;
};

/// 802.11g: ERP-OFDM, DSSS and CCK rates (IEEE Std 802.11-2016, clauses 15 to 18). The slot is 20
/// us, as in any independent BSS; ERP stations add a signal extension of 6 us to every OFDM PPDU
/// (18.3.2.4).
[[nodiscard]] const Standard& ieee80211g();

/// The standard of that name: "802.11a" (5 GHz OFDM), "802.11b" (DSSS and CCK), "802.11g" or
/// "802.11p" (OFDM in 10 MHz). `preamble` matters to DSSS and CCK rates only.
/// @throws std::invalid_argument naming those that exist.
[[nodiscard]] const Standard& standard_of(std::string_view name,
                                          DsssPreamble preamble = DsssPreamble::kLong);

/// Time on air of a PPDU [OFDM: 17.4.3; DSSS and CCK: 16.3.4]:
///
///   T = preamble + header + symbol · ⌈(service + 8 · PSDU + tail) / (rate · symbol)⌉ + extension.
[[nodiscard]] Duration airtime(const Mode& mode, std::uint32_t psdu_bytes);

/// From which basic rates a control answer is taken.
enum class ControlAnswerRule : std::uint8_t {
  kSameClass,  ///< Those of the class of modulation of the frame that is answered.
  kAnyClass    ///< OFDM frames may be answered by DSSS too, where such a basic rate is the highest.
};

/// Rate of the control answer to a frame received at `received` [10.6.6.5.2]: the highest basic
/// rate that the rule allows and that is not above it; where there is none, the highest mandatory
/// rate of the same class not above it. DSSS frames are never answered by OFDM: their senders may
/// not know it.
[[nodiscard]] const Mode& control_answer(const Standard& standard, const Mode& received,
                                         std::span<const std::uint32_t> basic_rates_kbps,
                                         ControlAnswerRule rule = ControlAnswerRule::kSameClass);

/// Sizes of what surrounds a payload [B].
inline constexpr std::uint32_t kDataHeaderBytes = 24;  ///< MAC header of a non-QoS data frame.
inline constexpr std::uint32_t kQosControlBytes = 2;   ///< More in that of a QoS data frame.
inline constexpr std::uint32_t kLlcSnapBytes = 8;
inline constexpr std::uint32_t kFcsBytes = 4;
inline constexpr std::uint32_t kAckBytes = 14;
inline constexpr std::uint32_t kCtsBytes = 14;
inline constexpr std::uint32_t kRtsBytes = 20;
inline constexpr std::uint32_t kEthernetHeaderBytes = 14;
inline constexpr std::uint32_t kMaximumMsduBytes = 2304;  ///< LLC/SNAP included.

/// PSDU of an Ethernet II frame (without FCS) that crosses the air: 14 B of Ethernet header become
/// a MAC header, LLC/SNAP and FCS.
[[nodiscard]] constexpr std::uint32_t psdu_bytes_of_ethernet(std::uint32_t frame_bytes) {
  return frame_bytes - kEthernetHeaderBytes + kLlcSnapBytes + kDataHeaderBytes + kFcsBytes;
}

}  // namespace cuscus::netsim
