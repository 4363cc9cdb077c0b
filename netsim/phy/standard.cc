#include "netsim/phy/standard.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <string>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;

// IEEE Std 802.11-2016, tables 17-5 (timing), 17-4 (rates); signal extension: table 18-5.
constexpr PpduFormat kErpOfdm{.preamble = microseconds{16},
                              .header = microseconds{4},
                              .header_bits = 24.0,
                              .header_modulation = Modulation::kBpsk,
                              .header_code_rate = CodeRate::kHalf,
                              .symbol = microseconds{4},
                              .service_bits = 16,
                              .tail_bits = 6,
                              .extension = microseconds{6}};

constexpr std::array<Mode, 8> kErpOfdmModes{{
    {6'000, Modulation::kBpsk, CodeRate::kHalf, 24, true, &kErpOfdm},
    {9'000, Modulation::kBpsk, CodeRate::kThreeQuarters, 36, false, &kErpOfdm},
    {12'000, Modulation::kQpsk, CodeRate::kHalf, 48, true, &kErpOfdm},
    {18'000, Modulation::kQpsk, CodeRate::kThreeQuarters, 72, false, &kErpOfdm},
    {24'000, Modulation::k16Qam, CodeRate::kHalf, 96, true, &kErpOfdm},
    {36'000, Modulation::k16Qam, CodeRate::kThreeQuarters, 144, false, &kErpOfdm},
    {48'000, Modulation::k64Qam, CodeRate::kTwoThirds, 192, false, &kErpOfdm},
    {54'000, Modulation::k64Qam, CodeRate::kThreeQuarters, 216, false, &kErpOfdm},
}};

constexpr Standard kIeee80211g{.name = "802.11g",
                               .bandwidth_hz = 20e6,
                               .slot = microseconds{20},
                               .sifs = microseconds{10},
                               .cca_time = microseconds{4},
                               .receive_start_delay = microseconds{20},
                               .cw_min = 15,
                               .cw_max = 1023,
                               .modes = kErpOfdmModes};

constexpr std::array<const Standard*, 1> kStandards{&kIeee80211g};

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

const Standard& ieee80211g() { return kIeee80211g; }

const Standard& standard_of(std::string_view name) {
  std::string allowed;
  for (const Standard* standard : kStandards) {
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
  const std::uint32_t bits = format.service_bits + 8 * psdu_bytes + format.tail_bits;
  const std::uint32_t symbols = (bits + mode.bits_per_symbol - 1) / mode.bits_per_symbol;
  return format.preamble + format.header + format.symbol * symbols + format.extension;
}

const Mode& control_answer(const Standard& standard, const Mode& received,
                           std::span<const std::uint32_t> basic_rates_kbps) {
  const Mode* best_basic = nullptr;
  const Mode* best_mandatory = nullptr;
  const auto better = [](const Mode& mode, const Mode* than) {
    return than == nullptr || mode.rate_kbps > than->rate_kbps;
  };
  for (const Mode& mode : standard.modes) {
    if (mode.rate_kbps > received.rate_kbps || mode.format != received.format) {
      continue;
    }
    const bool basic = std::find(basic_rates_kbps.begin(), basic_rates_kbps.end(),
                                 mode.rate_kbps) != basic_rates_kbps.end();
    if (basic && better(mode, best_basic)) {
      best_basic = &mode;
    }
    if (mode.mandatory && better(mode, best_mandatory)) {
      best_mandatory = &mode;
    }
  }
  if (best_basic != nullptr) {
    return *best_basic;
  }
  return best_mandatory != nullptr ? *best_mandatory : received;
}

}  // namespace cuscus::netsim
