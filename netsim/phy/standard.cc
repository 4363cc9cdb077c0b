#include "netsim/phy/standard.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <string>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;

// IEEE Std 802.11-2016, table 17-21 (OFDM timing at 20 and 10 MHz).
constexpr PpduFormat ofdm(int scale, int extension_us) {
  return {.preamble = microseconds{16 * scale},
          .header = microseconds{4 * scale},
          .header_bits = 24.0,
          .header_modulation = Modulation::kBpsk,
          .header_code_rate = CodeRate::kHalf,
          .symbol = microseconds{4 * scale},
          .service_bits = 16,
          .tail_bits = 6,
          .extension = microseconds{extension_us},
          .receive_start_delay = microseconds{20 * scale}};
}

// Clauses 15.2.2 and 16.2.2: SYNC and SFD, then 48 bits of PLCP header at 1 Mb/s (long) or 2 Mb/s.
// The payload ends on a whole microsecond (16.3.4).
constexpr PpduFormat dsss(int preamble_us, int header_us, Modulation header) {
  return {.preamble = microseconds{preamble_us},
          .header = microseconds{header_us},
          .header_bits = 48.0,
          .header_modulation = header,
          .header_code_rate = CodeRate::kUncoded,
          .symbol = microseconds{1},
          .service_bits = 0,
          .tail_bits = 0,
          .extension = microseconds{0},
          .receive_start_delay = microseconds{preamble_us + header_us}};
}

constexpr PpduFormat kOfdm = ofdm(1, 0);
constexpr PpduFormat kErpOfdm = ofdm(1, 6);  // signal extension: table 18-5
constexpr PpduFormat kHalfClockedOfdm = ofdm(2, 0);
constexpr PpduFormat kLongDsss = dsss(144, 48, Modulation::kDbpsk);
constexpr PpduFormat kShortDsss = dsss(72, 24, Modulation::kDqpsk);

// Tables 17-4 and 17-17: rates, and which every station has.
template <std::uint32_t scale>
constexpr std::array<Mode, 8> ofdm_modes(const PpduFormat* format) {
  constexpr auto kClass = ModulationClass::kOfdm;
  return {{{6'000 / scale, Modulation::kBpsk, CodeRate::kHalf, true, kClass, format},
           {9'000 / scale, Modulation::kBpsk, CodeRate::kThreeQuarters, false, kClass, format},
           {12'000 / scale, Modulation::kQpsk, CodeRate::kHalf, true, kClass, format},
           {18'000 / scale, Modulation::kQpsk, CodeRate::kThreeQuarters, false, kClass, format},
           {24'000 / scale, Modulation::k16Qam, CodeRate::kHalf, true, kClass, format},
           {36'000 / scale, Modulation::k16Qam, CodeRate::kThreeQuarters, false, kClass, format},
           {48'000 / scale, Modulation::k64Qam, CodeRate::kTwoThirds, false, kClass, format},
           {54'000 / scale, Modulation::k64Qam, CodeRate::kThreeQuarters, false, kClass, format}}};
}

constexpr std::array<Mode, 4> dsss_modes(const PpduFormat* format) {
  constexpr auto kClass = ModulationClass::kDsss;
  constexpr auto kUncoded = CodeRate::kUncoded;
  return {{{1'000, Modulation::kDbpsk, kUncoded, true, kClass, &kLongDsss},
           {2'000, Modulation::kDqpsk, kUncoded, true, kClass, format},
           {5'500, Modulation::kCck4Bit, kUncoded, true, kClass, format},
           {11'000, Modulation::kCck8Bit, kUncoded, true, kClass, format}}};
}

constexpr std::array<Mode, 12> erp_modes(const PpduFormat* format) {
  const auto dsss = dsss_modes(format);
  const auto ofdm = ofdm_modes<1>(&kErpOfdm);
  std::array<Mode, 12> modes{};
  std::merge(dsss.begin(), dsss.end(), ofdm.begin(), ofdm.end(), modes.begin(),
             [](const Mode& a, const Mode& b) { return a.rate_kbps < b.rate_kbps; });
  return modes;
}

constexpr auto kOfdmModes = ofdm_modes<1>(&kOfdm);
constexpr auto kHalfClockedModes = ofdm_modes<2>(&kHalfClockedOfdm);
constexpr auto kLongDsssModes = dsss_modes(&kLongDsss);
constexpr auto kShortDsssModes = dsss_modes(&kShortDsss);
constexpr auto kLongErpModes = erp_modes(&kLongDsss);
constexpr auto kShortErpModes = erp_modes(&kShortDsss);

// Bandwidth is that of the noise. DSSS occupies 22 MHz; its noise is counted in 20 MHz like that
// of OFDM, and its error rates with it (see dsss_bit_failure()).
constexpr Standard kIeee80211a{.name = "802.11a",
                               .bandwidth_hz = 20e6,
                               .slot = microseconds{9},
                               .sifs = microseconds{16},
                               .cca_time = microseconds{4},
                               .cw_min = 15,
                               .cw_max = 1023,
                               .modes = kOfdmModes};
constexpr Standard ieee80211b(std::span<const Mode> modes) {
  return {.name = "802.11b",
          .bandwidth_hz = 20e6,
          .slot = microseconds{20},
          .sifs = microseconds{10},
          .cca_time = microseconds{15},
          .cw_min = 31,
          .cw_max = 1023,
          .modes = modes};
}
constexpr Standard erp(std::span<const Mode> modes) {
  return {.name = "802.11g",
          .bandwidth_hz = 20e6,
          .slot = microseconds{20},
          .sifs = microseconds{10},
          .cca_time = microseconds{4},
          .cw_min = 15,
          .cw_max = 1023,
          .modes = modes};
}
constexpr Standard kIeee80211p{.name = "802.11p",
                               .bandwidth_hz = 10e6,
                               .slot = microseconds{13},
                               .sifs = microseconds{32},
                               .cca_time = microseconds{8},
                               .cw_min = 15,
                               .cw_max = 1023,
                               .modes = kHalfClockedModes};

constexpr Standard kLongIeee80211b = ieee80211b(kLongDsssModes);
constexpr Standard kShortIeee80211b = ieee80211b(kShortDsssModes);
constexpr Standard kLongIeee80211g = erp(kLongErpModes);
constexpr Standard kShortIeee80211g = erp(kShortErpModes);

constexpr std::array<const Standard*, 4> kWithLongPreamble{&kIeee80211a, &kLongIeee80211b,
                                                           &kLongIeee80211g, &kIeee80211p};
constexpr std::array<const Standard*, 4> kWithShortPreamble{&kIeee80211a, &kShortIeee80211b,
                                                            &kShortIeee80211g, &kIeee80211p};

}  // namespace

const Mode& Standard::mode(std::uint32_t rate_kbps) const {
  std::string allowed;
  for (const Mode& mode : modes) {
    if (mode.rate_kbps == rate_kbps) {
      return mode;
    }
    allowed += (allowed.empty() ? "" : ", ") + std::to_string(mode.rate_kbps);
  }
  throw std::invalid_argument{std::string{name} + " has no rate of " + std::to_string(rate_kbps) +
                              " kb/s; allowed are " + allowed};
}

const Standard& ieee80211g() { return kLongIeee80211g; }

const Standard& standard_of(std::string_view name, DsssPreamble preamble) {
  std::string allowed;
  for (const Standard* standard :
       preamble == DsssPreamble::kLong ? kWithLongPreamble : kWithShortPreamble) {
    if (standard->name == name) {
      return *standard;
    }
    allowed += (allowed.empty() ? "'" : ", '") + std::string{standard->name} + "'";
  }
  throw std::invalid_argument{"radio standard '" + std::string{name} +
                              "' is not known; allowed are " + allowed};
}

Duration airtime(const Mode& mode, std::uint32_t psdu_bytes) {
  const PpduFormat& format = *mode.format;
  // rate [kb/s] · symbol [ns] is bits per symbol times 10^6: whole numbers, also at 5.5 Mb/s.
  const std::uint64_t bits = format.service_bits + std::uint64_t{8} * psdu_bytes + format.tail_bits;
  const std::uint64_t symbol_bits_e6 =
      mode.rate_kbps * static_cast<std::uint64_t>(format.symbol.count());
  const std::uint64_t symbols = (bits * 1'000'000 + symbol_bits_e6 - 1) / symbol_bits_e6;
  return format.preamble + format.header + format.symbol * static_cast<Duration::rep>(symbols) +
         format.extension;
}

const Mode& control_answer(const Standard& standard, const Mode& received,
                           std::span<const std::uint32_t> basic_rates_kbps,
                           ControlAnswerRule rule) {
  const Mode* best_basic = nullptr;
  const Mode* best_mandatory = nullptr;
  for (const Mode& mode : standard.modes) {  // upwards: the last that fits is the best
    if (mode.rate_kbps > received.rate_kbps) {
      break;
    }
    const bool same_class = mode.modulation_class == received.modulation_class;
    const bool allowed = same_class || (rule == ControlAnswerRule::kAnyClass &&
                                        mode.modulation_class == ModulationClass::kDsss);
    const bool basic = std::find(basic_rates_kbps.begin(), basic_rates_kbps.end(),
                                 mode.rate_kbps) != basic_rates_kbps.end();
    best_basic = allowed && basic ? &mode : best_basic;
    best_mandatory = same_class && mode.mandatory ? &mode : best_mandatory;
  }
  if (best_basic != nullptr) {
    return *best_basic;
  }
  return best_mandatory != nullptr ? *best_mandatory : received;
}

}  // namespace cuscus::netsim
