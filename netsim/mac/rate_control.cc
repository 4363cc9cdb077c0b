#include "netsim/mac/rate_control.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/units/decibel.h"
#include "netsim/mac/aarf_rate.h"
#include "netsim/mac/minstrel_rate.h"

namespace cuscus::netsim {
namespace {

double snr_required(const ErrorModel& errors, const Mode& mode) {
  constexpr double kBitFailure = 1e-6;
  double low_db = -20.0;
  double high_db = 60.0;
  while (high_db - low_db > 1e-3) {
    const double middle_db = 0.5 * (low_db + high_db);
    const double snr = Decibel{middle_db}.ratio();
    (errors.bit_failure(mode.modulation, mode.code_rate, snr) > kBitFailure ? low_db : high_db) =
        middle_db;
  }
  return Decibel{high_db}.ratio();
}

}  // namespace

std::size_t index_of(const RateSetting& setting, const Mode& mode) {
  const auto found = std::find(setting.modes.begin(), setting.modes.end(), &mode);
  return static_cast<std::size_t>(found - setting.modes.begin());
}

RateSetting rate_setting(const Standard& standard, const Mode& first, const ErrorModel& errors) {
  RateSetting setting;
  setting.first = &first;
  for (const Mode& mode : standard.modes) {
    if (mode.modulation_class == first.modulation_class) {
      setting.modes.push_back(&mode);
      setting.required_snr.push_back(snr_required(errors, mode));
    }
  }
  return setting;
}

const Mode& IdealRate::mode(SimTime /*now*/, std::uint32_t peer, std::uint32_t /*attempt*/) {
  const double snr = grown_to(snr_, peer);
  if (snr == 0.0) {
    return *setting_.first;
  }
  const Mode* best = setting_.modes.front();
  for (std::size_t rate = 0; rate < setting_.modes.size(); ++rate) {
    if (snr >= setting_.required_snr[rate]) {
      best = setting_.modes[rate];
    }
  }
  return *best;
}

void IdealRate::heard(std::uint32_t peer, double snr_ratio) { grown_to(snr_, peer) = snr_ratio; }

std::unique_ptr<RateControl> make_rate_control(std::string_view name, const RateSetting& setting) {
  if (name == "constant") {
    return std::make_unique<ConstantRate>(setting);
  }
  if (name == "ideal") {
    return std::make_unique<IdealRate>(setting);
  }
  if (name == "aarf") {
    return std::make_unique<AarfRate>(setting);
  }
  if (name == "minstrel") {
    return std::make_unique<MinstrelRate>(setting);
  }
  throw std::invalid_argument{
      "rate control '" + std::string{name} +
      "' is not known; allowed are 'constant', 'ideal', 'aarf', 'minstrel'"};
}

}  // namespace cuscus::netsim
