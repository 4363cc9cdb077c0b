#include "netsim/capture/radiotap.h"

#include <algorithm>
#include <cmath>

#include "netsim/capture/octet_writer.h"

namespace cuscus::netsim {
namespace {

// Bits of the fields that we use (radiotap.org, "Defined fields").
constexpr std::uint32_t kMacTime = 1U << 0U;
constexpr std::uint32_t kFlags = 1U << 1U;
constexpr std::uint32_t kRate = 1U << 2U;
constexpr std::uint32_t kChannel = 1U << 3U;
constexpr std::uint32_t kSignal_dbm = 1U << 5U;
constexpr std::uint32_t kNoise_dbm = 1U << 6U;
constexpr std::uint32_t kTxPower_dbm = 1U << 10U;
constexpr std::uint32_t kTxFlags = 1U << 15U;
constexpr std::uint32_t kDataRetries = 1U << 17U;

// Field "flags".
constexpr std::uint8_t kShortPreamble = 0x02;
constexpr std::uint8_t kFcsAtEnd = 0x10;
constexpr std::uint8_t kBadFcs = 0x40;

// Field "channel".
constexpr std::uint16_t kCck = 0x0020;
constexpr std::uint16_t kOfdm = 0x0040;
constexpr std::uint16_t k2GHz = 0x0080;
constexpr std::uint16_t k5GHz = 0x0100;
constexpr std::uint16_t kHalfRate = 0x4000;

// Field "TX flags".
constexpr std::uint16_t kNoAck = 0x0008;

/// Rates are in units of 500 kb/s.
constexpr std::uint32_t kRateUnit_kbps = 500;

std::uint8_t level_octet(double level_dbm) {
  constexpr double kLeast = -128.0;
  constexpr double kMost = 127.0;
  return static_cast<std::uint8_t>(
      static_cast<std::int8_t>(std::lround(std::clamp(level_dbm, kLeast, kMost))));
}

}  // namespace

RadiotapChannel radiotap_channel(double carrier_hz, double bandwidth_hz,
                                 ModulationClass modulation_class) {
  constexpr double kMegahertz = 1e6;
  constexpr double kMost_mhz = 65'535.0;
  constexpr double kHalfRateBandwidth_hz = 10e6;
  const double mhz = std::clamp(carrier_hz / kMegahertz, 0.0, kMost_mhz);
  RadiotapChannel channel;
  channel.frequency_mhz = static_cast<std::uint16_t>(std::lround(mhz));
  channel.flags = modulation_class == ModulationClass::kDsss ? kCck : kOfdm;
  if (mhz >= 2'400.0 && mhz < 2'500.0) {
    channel.flags |= k2GHz;
  } else if (mhz >= 4'900.0 && mhz < 5'950.0) {
    channel.flags |= k5GHz;
  }
  if (bandwidth_hz == kHalfRateBandwidth_hz) {
    channel.flags |= kHalfRate;
  }
  return channel;
}

void append_radiotap(std::vector<std::uint8_t>& octets, const RadiotapHeader& header) {
  OctetWriter out{octets};
  const std::size_t begin = out.position();
  constexpr std::size_t kLengthOffset = 2;
  constexpr std::uint8_t kVersion = 0;
  std::uint32_t present = kMacTime | kFlags | kRate | kChannel;
  present |= header.received ? kSignal_dbm | kNoise_dbm : 0;
  present |= header.transmitted ? kTxPower_dbm | kTxFlags | kDataRetries : 0;
  out.u8(kVersion);
  out.u8(0);   // padding
  out.u16(0);  // the length, once it is known
  out.u32(present);
  out.u64(header.mac_time_us);
  out.u8(static_cast<std::uint8_t>(kFcsAtEnd | (header.short_preamble ? kShortPreamble : 0) |
                                   (header.bad_fcs ? kBadFcs : 0)));
  out.u8(static_cast<std::uint8_t>(header.rate_kbps / kRateUnit_kbps));
  out.u16(header.channel.frequency_mhz);
  out.u16(header.channel.flags);
  if (header.received) {
    out.u8(level_octet(header.received->signal_dbm));
    out.u8(level_octet(header.received->noise_dbm));
  }
  if (header.transmitted) {
    constexpr std::uint32_t kMostRetries = 255;
    out.u8(level_octet(header.transmitted->power_dbm));
    out.pad(begin, sizeof(std::uint16_t));
    out.u16(header.transmitted->no_ack ? kNoAck : 0);
    out.u8(static_cast<std::uint8_t>(std::min(header.transmitted->retries, kMostRetries)));
  }
  out.replace_u16(begin + kLengthOffset, static_cast<std::uint16_t>(out.position() - begin));
}

}  // namespace cuscus::netsim
