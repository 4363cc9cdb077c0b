#include "netsim/channel/shadowing.h"

#include <cmath>
#include <numbers>

#include "common/random/counter_stream.h"

namespace cuscus::netsim {
namespace {

// Purpose numbers of the streams (see random::stream_id).
constexpr std::uint16_t kFieldStream = 0x1007;
constexpr std::uint16_t kVisibilityStream = 0x1010;

}  // namespace

Shadowing::Shadowing(const Parameters& parameters)
    : amplitude_db_{parameters.deviation_db * std::sqrt(2.0 / kWaves)} {
  const std::uint16_t purpose =
      parameters.purpose == Purpose::kVisibility ? kVisibilityStream : kFieldStream;
  const random::CounterStream draws{parameters.seed, random::stream_id(purpose, 0)};
  std::uint64_t draw = 0;
  // A normal vector over the modulus of a normal variable is Cauchy distributed.
  const auto spatial_frequency = [&] {
    const Eigen::Vector3d normal{draws.normal(draw), draws.normal(draw + 1),
                                 draws.normal(draw + 2)};
    const double divisor = std::abs(draws.normal(draw + 3));
    draw += 4;
    return Eigen::Vector3d{normal / (divisor * parameters.decorrelation_m)};
  };
  for (Wave& wave : waves_) {
    wave.at_low = spatial_frequency();
    wave.at_high = spatial_frequency();
    wave.phase_rad = 2.0 * std::numbers::pi * draws.uniform(draw++);
  }
}

Decibel Shadowing::loss(const Link& link) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    sum += std::cos(wave.at_low.dot(link.p_WL) + wave.at_high.dot(link.p_WH) + wave.phase_rad);
  }
  return {amplitude_db_ * sum};
}

}  // namespace cuscus::netsim
