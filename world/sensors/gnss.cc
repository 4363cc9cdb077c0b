#include "world/sensors/gnss.h"

#include <cmath>
#include <span>

#include "common/random/counter_stream.h"
#include "world/sensors/position_solution.h"
#include "world/sensors/white_noise.h"

namespace cuscus::world {
namespace {

const Eigen::Vector3d kAntennaPlace_B_m{0.0, 0.0, 0.1};

double normal(std::uint64_t seed, std::uint16_t purpose, std::uint32_t node, std::size_t satellite,
              std::uint64_t reading) {
  const std::uint64_t stream =
      random::stream_id(purpose, node, static_cast<std::uint16_t>(satellite));
  return random::CounterStream{seed, stream}.normal(reading);
}

/// The satellites whose signals arrive, and the errors of what is measured of them.
struct Received {
  std::array<Eigen::Vector3d, kSatellites> directions;
  std::array<double, kSatellites> range_errors_m;
  std::array<double, kSatellites> rate_errors_mps;
  std::size_t count{0};

  template <typename T>
  [[nodiscard]] std::span<const T> of(const std::array<T, kSatellites>& all) const {
    return std::span{all}.first(count);
  }
};

}  // namespace

Gnss::Gnss(std::uint64_t seed, std::uint32_t node, const GnssParameters& parameters,
           const Constellation& sky)
    : seed_{seed},
      node_{node},
      parameters_{parameters},
      sky_{sky},
      persistence_{
          std::exp(-to_seconds(parameters.period) / to_seconds(parameters.correlation_time))} {}

void Gnss::drift(std::uint64_t reading) {
  const double fresh = std::sqrt(1.0 - persistence_ * persistence_);
  for (std::size_t satellite = 0; satellite < kSatellites; ++satellite) {
    const double draw_m =
        parameters_.drift_m * normal(seed_, NoisePurpose::kGnssDrift, node_, satellite, reading);
    drift_m_[satellite] =
        reading == 0 ? draw_m : persistence_ * drift_m_[satellite] + fresh * draw_m;
  }
}

GnssSample Gnss::sample(const Surroundings& surroundings, const RigidBodyState& body, SimTime time,
                        std::uint64_t reading) {
  drift(reading);
  const Eigen::Vector3d p_WA = body.p_WB_m + body.q_WB * kAntennaPlace_B_m;
  const double lowest_sine = std::sin(parameters_.mask_rad);
  const auto directions = sky_.directions(time);
  GnssSample sample{};
  Received received;
  for (std::size_t satellite = 0; satellite < kSatellites; ++satellite) {
    const Eigen::Vector3d& direction = directions[satellite];
    if (direction.z() < lowest_sine) {
      continue;
    }
    ++sample.in_view;
    const auto foliage_m = surroundings.foliage_to_sky_m(p_WA, direction);
    const double loss_db = foliage_m ? foliage_attenuation_db(*foliage_m) : kGnssMargin_db;
    if (loss_db >= kGnssMargin_db) {
      continue;
    }
    const double white_m = parameters_.noise_m * std::pow(10.0, loss_db / 20.0);
    received.directions[received.count] = direction;
    received.range_errors_m[received.count] =
        drift_m_[satellite] +
        white_m * normal(seed_, NoisePurpose::kGnssRange, node_, satellite, reading);
    received.rate_errors_mps[received.count] =
        parameters_.rate_noise_mps *
        normal(seed_, NoisePurpose::kGnssRangeRate, node_, satellite, reading);
    ++received.count;
  }
  sample.received = static_cast<std::uint32_t>(received.count);
  const auto used = received.of(received.directions);
  if (const auto solution = PositionSolution::of(used)) {
    sample.fix =
        GnssFix{.p_WB_m = body.p_WB_m + solution->error(used, received.of(received.range_errors_m)),
                .v_WB_W_mps =
                    body.v_WB_W_mps + solution->error(used, received.of(received.rate_errors_mps)),
                .hdop = solution->hdop(),
                .vdop = solution->vdop()};
  }
  return sample;
}

double foliage_attenuation_db(double length_m) {
  constexpr double kSpecific_dbpm = 0.26;
  constexpr double kGreatest_db = 28.2;
  return -kGreatest_db * std::expm1(-length_m * kSpecific_dbpm / kGreatest_db);
}

}  // namespace cuscus::world
