#include "netsim/channel/gaussian_field.h"

#include <cmath>
#include <numbers>

#include "common/random/counter_stream.h"

namespace cuscus::netsim {

GaussianField::GaussianField(const Parameters& parameters) {
  const random::CounterStream draws{parameters.seed, random::stream_id(parameters.purpose, 0)};
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

double GaussianField::value(const Eigen::Vector3d& p_WL, const Eigen::Vector3d& p_WH) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    sum += std::cos(wave.at_low.dot(p_WL) + wave.at_high.dot(p_WH) + wave.phase_rad);
  }
  return std::sqrt(2.0 / kWaves) * sum;
}

}  // namespace cuscus::netsim
