#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// What the radiotap field "channel" says.
struct RadiotapChannel {
  std::uint16_t frequency_mhz{};
  std::uint16_t flags{};
};

/// The channel of a frame: its modulation, the band (2.4 GHz or 5 GHz, where the carrier is in one
/// of them) and "half rate" in 10 MHz.
[[nodiscard]] RadiotapChannel radiotap_channel(double carrier_hz, double bandwidth_hz,
                                               ModulationClass modulation_class);

/// What a radiotap header says of one frame. FCS at end is always set: our frames have theirs.
struct RadiotapHeader {
  /// TSFT: when the first bit of the MPDU arrived, or left [us].
  std::uint64_t mac_time_us{};
  bool short_preamble{};
  bool bad_fcs{};
  std::uint32_t rate_kbps{};
  RadiotapChannel channel{};

  struct Received {
    double signal_dbm{};
    double noise_dbm{};
  };
  struct Transmitted {
    double power_dbm{};
    bool no_ack{};  ///< None is expected.
    std::uint32_t retries{};
  };
  std::optional<Received> received{};        ///< Of a frame that came from the air.
  std::optional<Transmitted> transmitted{};  ///< Of one's own.
};

/// Appends the header, in the layout of radiotap.org: 8 octets of version, length and a bit per
/// field, then the fields in the order of their bits, each aligned to its size from the header's
/// beginning, all little-endian. Levels are rounded to whole dBm and clamped to what 8 bits hold.
void append_radiotap(std::vector<std::uint8_t>& octets, const RadiotapHeader& header);

}  // namespace cuscus::netsim
