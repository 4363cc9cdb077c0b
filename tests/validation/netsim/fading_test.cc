// Fading and shadowing against the distributions and correlations that they claim.
#include "netsim/channel/fading.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "common/units/constants.h"
#include "netsim/channel/shadowing.h"

namespace cuscus::netsim {
namespace {

constexpr double kCarrier_hz = 2.437e9;
const double kWavelength_m = kSpeedOfLight_mps / kCarrier_hz;
const double kWaveNumber_radpm = 2.0 * std::numbers::pi / kWavelength_m;
constexpr double kRayleigh_db = -std::numeric_limits<double>::infinity();

RiceFading rice(double k_db, std::uint64_t seed) {
  return RiceFading{{.k_at_horizon = {k_db},
                     .k_at_zenith = {k_db},
                     .residual_doppler_hz = 0.0,
                     .carrier_hz = kCarrier_hz,
                     .seed = seed}};
}

/// Node 1 at `p_W` as node 0 hears it from 200 m to its west.
FrameOnLink frame_at(const Eigen::Vector3d& p_W, std::uint64_t transmission = 0) {
  return {.link = Link::between(0, {-200.0, 0.0, 10.0}, 1, p_W),
          .from_low = false,
          .transmission = transmission,
          .time = {}};
}

double power(const FadingModel& fading, const FrameOnLink& frame) {
  return (-fading.loss(frame)).ratio();
}

/// The largest distance between the samples' distribution and `cdf`.
double kolmogorov_smirnov(std::vector<double> samples, const std::function<double(double)>& cdf) {
  std::sort(samples.begin(), samples.end());
  const auto n = static_cast<double>(samples.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double expected = cdf(samples[i]);
    distance = std::max({distance, std::abs(expected - static_cast<double>(i) / n),
                         std::abs(expected - static_cast<double>(i + 1) / n)});
  }
  return distance;
}

/// Above this distance the hypothesis of equal distributions is rejected at 1 %.
double critical_distance(std::size_t samples) {
  return 1.63 / std::sqrt(static_cast<double>(samples));
}

/// Powers at places of one seed each, in a plane and so far apart that they know nothing of each
/// other.
std::vector<double> independent_powers(double k_db, std::size_t count) {
  std::vector<double> powers;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    powers.push_back(power(rice(k_db, seed), frame_at({17.0, 3.0, 10.0})));
  }
  return powers;
}

TEST_CASE("Rayleigh powers are exponentially distributed, with mean 1") {
  const auto powers = independent_powers(kRayleigh_db, 2'000);

  CHECK(kolmogorov_smirnov(powers, [](double x) { return 1.0 - std::exp(-x); }) <
        critical_distance(powers.size()));
  double mean = 0.0;
  for (const double x : powers) {
    mean += x / static_cast<double>(powers.size());
  }
  CHECK(mean == Approx(1.0).margin(0.07));  // three standard errors of 1/sqrt(2000)
}

TEST_CASE(
    "deep fades of sixteen waves are as frequent as documented, and none is stronger than all") {
  double deep = 0.0;
  double strongest = 0.0;
  constexpr int kSeeds = 200;
  constexpr int kPlaces = 500;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const RiceFading fading = rice(kRayleigh_db, seed);
    for (int place = 0; place < kPlaces; ++place) {
      const double x = power(fading, frame_at({0.37 * place, 0.11 * place, 12.0}));
      deep += x < 0.1 ? 1.0 : 0.0;
      strongest = std::max(strongest, x);
    }
  }
  // Theory has 1 - exp(-0.1) = 0.0952. Standard error of 10^5 correlated places: about 0.001.
  CHECK(deep / (kSeeds * kPlaces) == Approx(0.093).margin(0.004));
  CHECK(strongest <= rice(kRayleigh_db, 1).greatest_gain().ratio());
}

TEST_CASE("Rice powers follow the distribution of their K") {
  const double k_db = GENERATE(0.0, 6.0, 12.0);
  const double k = Decibel{k_db}.ratio();
  // Density of the power: (K+1) exp(-K - (K+1) x) I0(2 sqrt(K (K+1) x)), integrated by Simpson.
  const auto density = [&](double x) {
    return (k + 1.0) * std::exp(-k - (k + 1.0) * x) *
           std::cyl_bessel_i(0.0, 2.0 * std::sqrt(k * (k + 1.0) * x));
  };
  const auto cdf = [&](double x) {
    constexpr int kSteps = 400;
    double sum = density(0.0) + density(x);
    for (int i = 1; i < kSteps; ++i) {
      sum += (i % 2 == 1 ? 4.0 : 2.0) * density(x * i / kSteps);
    }
    return std::min(1.0, sum * x / (3.0 * kSteps));
  };
  const auto powers = independent_powers(k_db, 2'000);
  CAPTURE(k_db);

  CHECK(kolmogorov_smirnov(powers, cdf) < critical_distance(powers.size()));
}

/// Of each field of seeds 1 ... count, sampled while node 1 moves over 20 wavelengths.
template <typename Visit>
void along_tracks(int count, double step_m, const Visit& visit) {
  for (int seed = 1; seed <= count; ++seed) {
    const RiceFading fading = rice(kRayleigh_db, static_cast<std::uint64_t>(seed));
    const double heading_rad = 0.1 * seed;
    std::vector<double> track;
    for (double along_m = 0.0; along_m < 20.0 * kWavelength_m; along_m += step_m) {
      track.push_back(power(fading, frame_at({along_m * std::cos(heading_rad),
                                              along_m * std::sin(heading_rad), 10.0})));
    }
    visit(track);
  }
}

TEST_CASE("the power of a node that moves is correlated as J0 squared") {
  // J0(k d cos e), averaged over elevations of +-20 deg.
  const auto correlation = [](double distance_rad) {
    constexpr int kSteps = 200;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double elevation_rad =
          (2.0 * (i + 0.5) / kSteps - 1.0) * 20.0 * std::numbers::pi / 180.0;
      sum += std::cyl_bessel_j(0.0, distance_rad * std::cos(elevation_rad)) / kSteps;
    }
    return sum;
  };
  constexpr double kStep_rad = 0.2;
  constexpr std::size_t kLags = 20;  // up to 3.8 rad
  std::vector<double> products(kLags, 0.0);
  double sum = 0.0;
  double count = 0.0;
  along_tracks(300, kStep_rad / kWaveNumber_radpm, [&](const std::vector<double>& track) {
    for (std::size_t i = 0; i + kLags < track.size(); ++i) {
      for (std::size_t lag = 0; lag < kLags; ++lag) {
        products[lag] += track[i] * track[i + lag];
      }
      sum += track[i];
      count += 1.0;
    }
  });
  const double mean = sum / count;
  const double variance = products[0] / count - mean * mean;
  for (std::size_t lag = 0; lag < kLags; ++lag) {
    // Of N waves of equal power the squares are correlated as (R^2 - 1/N) / (1 - 1/N): the waves'
    // own powers do not vary.
    constexpr double kWaves = 16.0;
    const double field = correlation(kStep_rad * static_cast<double>(lag));
    const double expected = (field * field - 1.0 / kWaves) / (1.0 - 1.0 / kWaves);
    CAPTURE(lag);
    CHECK((products[lag] / count - mean * mean) / variance == Approx(expected).margin(0.03));
  }
}

TEST_CASE("fades cross a level as often as theory says") {
  // sqrt(2 pi) rho exp(-rho^2) crossings upwards per wavelength of a plane ring of waves [Jakes
  // 1974, 1.3-35]; elevations of +-20 deg take the root of their mean cos^2, 2 %, off it.
  const double rho = GENERATE(0.3, 0.5, 1.0);
  double crossings = 0.0;
  double wavelengths = 0.0;
  along_tracks(300, kWavelength_m / 200.0, [&](const std::vector<double>& track) {
    for (std::size_t i = 1; i < track.size(); ++i) {
      crossings += track[i - 1] < rho * rho && track[i] >= rho * rho ? 1.0 : 0.0;
    }
    wavelengths += 20.0;
  });
  CAPTURE(rho);

  const double expected = std::sqrt(2.0 * std::numbers::pi) * rho * std::exp(-rho * rho) * 0.98;
  CHECK(crossings / wavelengths == Approx(expected).epsilon(0.08));
}

TEST_CASE("retries within milliseconds share a fade, beacons 50 ms apart do not") {
  // 5 m/s: 1 ms is 5 mm, a twenty-fifth of a wavelength; 50 ms are two wavelengths.
  double after_retry = 0.0;
  double after_beacon = 0.0;
  double deep = 0.0;
  constexpr double kDeep = 0.1;  // -10 dB
  for (std::uint64_t seed = 1; seed <= 3'000; ++seed) {
    const RiceFading fading = rice(kRayleigh_db, seed);
    if (power(fading, frame_at({0.0, 0.0, 10.0})) < kDeep) {
      deep += 1.0;
      after_retry += power(fading, frame_at({0.005, 0.0, 10.0})) < kDeep ? 1.0 : 0.0;
      after_beacon += power(fading, frame_at({0.25, 0.0, 10.0})) < kDeep ? 1.0 : 0.0;
    }
  }
  REQUIRE(deep > 200.0);  // of 0.092 * 3000
  CHECK(after_retry / deep > 0.6);
  CHECK(after_beacon / deep < 0.2);
}

TEST_CASE("Nakagami powers are Gamma distributed") {
  const double m = GENERATE(0.5, 1.0, 2.768);
  const NakagamiFading fading{3, m};
  constexpr int kDraws = 40'000;
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = power(fading, frame_at(Eigen::Vector3d::Zero(), i));
    sum += x;
    squares += x * x;
  }
  CAPTURE(m);
  const double mean = sum / kDraws;
  // Standard errors: sqrt(1/m/n) of the mean, at most 0.007; of the variance at most 4 %.
  CHECK(mean == Approx(1.0).margin(0.03));
  CHECK(squares / kDraws - mean * mean == Approx(1.0 / m).epsilon(0.12));
}

TEST_CASE("shadowing has its deviation, and keeps 1/e over the decorrelation distance") {
  constexpr double kDeviation_db = 6.0;
  constexpr double kDecorrelation_m = 15.0;
  const double moved_m = GENERATE(0.0, 5.0, 15.0, 40.0);
  const bool both_ends = GENERATE(false, true);
  double squares = 0.0;
  double products = 0.0;
  constexpr int kFields = 3'000;
  for (std::uint64_t seed = 1; seed <= kFields; ++seed) {
    const Shadowing shadowing{
        {.deviation_db = kDeviation_db, .decorrelation_m = kDecorrelation_m, .seed = seed}};
    const Eigen::Vector3d p_W{80.0, 30.0, 20.0};
    const Eigen::Vector3d moved = Eigen::Vector3d{0.6, 0.0, 0.8} * moved_m;
    const Eigen::Vector3d other = both_ends ? moved : Eigen::Vector3d::Zero();
    const double here = shadowing.loss(Link::between(0, Eigen::Vector3d::Zero(), 1, p_W)).value;
    const double there = shadowing.loss(Link::between(0, other, 1, p_W + moved)).value;
    squares += here * here;
    products += here * there;
  }
  CAPTURE(moved_m, both_ends);
  const double correlation = std::exp(-moved_m / kDecorrelation_m) *
                             (both_ends ? std::exp(-moved_m / kDecorrelation_m) : 1.0);
  // Standard errors: 36 sqrt(2/n) = 0.9 of the variance, 1/sqrt(n) = 0.02 of the correlation.
  CHECK(squares / kFields == Approx(36.0).margin(3.0));
  CHECK(products / squares == Approx(correlation).margin(0.07));
}

}  // namespace
}  // namespace cuscus::netsim
