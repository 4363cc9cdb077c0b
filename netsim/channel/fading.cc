#include "netsim/channel/fading.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "common/units/constants.h"

namespace cuscus::netsim {
namespace {

// Purposes of random streams (see random::stream_id).
constexpr std::uint16_t kWaveStream = 0x1004;
constexpr std::uint16_t kWavePhaseStream = 0x1005;
constexpr std::uint16_t kNakagamiStream = 0x1006;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kElevationSpread_rad = 20.0 * std::numbers::pi / 180.0;

/// Deepest fade: a channel of nothing at all would be infinitely deep.
constexpr double kLeastPower = 1e-20;

Eigen::Vector3d direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

random::CounterStream stream_of(std::uint64_t seed, std::uint16_t purpose, const Link& link) {
  return {seed, random::stream_id(purpose, link.high, static_cast<std::uint16_t>(link.low))};
}

/// Gamma with this shape, of at least 1, and scale 1; draws from `first` on.
double gamma_variate(const random::CounterStream& stream, std::uint64_t first, double shape) {
  const double d = shape - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  for (std::uint64_t draw = first;; draw += 2) {
    const double x = stream.normal(draw);
    const double v = std::pow(1.0 + c * x, 3.0);
    if (v > 0.0 &&
        std::log(1.0 - stream.uniform(draw + 1)) < 0.5 * x * x + d - d * v + d * std::log(v)) {
      return d * v;
    }
  }
}

}  // namespace

FrameDraw FrameDraw::of(std::uint64_t seed, std::uint16_t purpose, const FrameOnLink& frame) {
  return {stream_of(seed, purpose, frame.link), 2 * frame.transmission + (frame.from_low ? 0 : 1)};
}

RiceFading::RiceFading(const Parameters& parameters)
    : parameters_{parameters},
      wave_number_radpm_{kTurn_rad * parameters.carrier_hz / kSpeedOfLight_mps} {
  const random::CounterStream draws{parameters.seed, random::stream_id(kWaveStream, 0)};
  std::uint64_t draw = 0;
  const auto symmetric = [&](double most) { return most * (2.0 * draws.uniform(draw++) - 1.0); };
  // One wave per sixteenth of the circle at either end, in independent orders.
  std::array<std::size_t, kWaves> order{};
  for (std::size_t i = 0; i < kWaves; ++i) {
    order[i] = i;
    std::swap(order[i], order[draws.below(draw++, static_cast<std::uint32_t>(i + 1))]);
  }
  const auto azimuth = [&](std::size_t sector) {
    return kTurn_rad * (static_cast<double>(sector) + draws.uniform(draw++)) / kWaves;
  };
  for (std::size_t i = 0; i < kWaves; ++i) {
    const double low_rad = azimuth(i);
    const double high_rad = azimuth(order[i]);
    waves_[i] = {
        .at_low = wave_number_radpm_ * direction(low_rad, symmetric(kElevationSpread_rad)),
        .at_high = wave_number_radpm_ * direction(high_rad, symmetric(kElevationSpread_rad)),
        .turn_radps = kTurn_rad * symmetric(parameters.residual_doppler_hz)};
  }
}

double RiceFading::k_factor(double elevation_rad) const {
  const double share = elevation_rad / (std::numbers::pi / 2.0);
  const double horizon = parameters_.k_at_horizon.ratio();
  return horizon > 0.0 ? horizon * std::pow(parameters_.k_at_zenith.ratio() / horizon, share) : 0.0;
}

Decibel RiceFading::loss(const FrameOnLink& frame) const {
  const Link& link = frame.link;
  const random::CounterStream phases = stream_of(parameters_.seed, kWavePhaseStream, link);
  const double time_s = to_seconds(frame.time - SimTime{});
  std::complex<double> scattered{0.0, 0.0};
  for (std::size_t i = 0; i < kWaves; ++i) {
    const Wave& wave = waves_[i];
    scattered += std::polar(1.0, kTurn_rad * phases.uniform(i) + wave.at_low.dot(link.p_WL) +
                                     wave.at_high.dot(link.p_WH) + wave.turn_radps * time_s);
  }
  const Eigen::Vector3d between_m = link.p_WH - link.p_WL;
  const double distance_m = between_m.norm();
  const double elevation_rad =
      distance_m > 0.0 ? std::asin(std::min(1.0, std::abs(between_m.z()) / distance_m)) : 0.0;
  const double k = k_factor(elevation_rad);
  const std::complex<double> h =
      std::polar(std::sqrt(k / (k + 1.0)), wave_number_radpm_ * distance_m) +
      scattered / std::sqrt((k + 1.0) * kWaves);
  return -Decibel::from_ratio(std::max(std::norm(h), kLeastPower));
}

Decibel NakagamiFading::loss(const FrameOnLink& frame) const {
  const auto [stream, index] = FrameDraw::of(seed_, kNakagamiStream, frame);
  constexpr std::uint64_t kDrawsPerFrame = 1'024;  // two per trial, of which 19 in 20 succeed
  const std::uint64_t first = index * kDrawsPerFrame;
  double power = 0.0;
  if (m_ >= 1.0) {
    power = gamma_variate(stream, first, m_) / m_;
  } else {
    const double boost = std::pow(1.0 - stream.uniform(first), 1.0 / m_);
    power = boost * gamma_variate(stream, first + 1, m_ + 1.0) / m_;
  }
  return -Decibel::from_ratio(std::max(power, kLeastPower));
}

}  // namespace cuscus::netsim
