#include "netsim/link/link_curve.h"

#include <cmath>

namespace cuscus::netsim {
namespace {

// No OFDM rate passes anything below, and none needs more than the end.
constexpr double kLowest_db = -4.0;
constexpr double kHighest_db = 40.0;
constexpr std::uint64_t kGlance = 100;

bool nearly_all_lost(const LinkPoint& point) { return 20 * point.failures > 19 * point.frames; }

}  // namespace

double LinkPoint::bit_failure() const {
  const double survived = 1.0 - static_cast<double>(failures) / static_cast<double>(frames);
  return -std::expm1(std::log(survived) / static_cast<double>(frame_bits));
}

LinkPoint sample_link(const OfdmLink& link, double snr_db, std::uint64_t frame_bits,
                      const LinkSampling& sampling) {
  LinkPoint point{.snr_db = snr_db, .frame_bits = frame_bits};
  while (point.failures < sampling.failures && point.frames < sampling.frames) {
    const bool survived = link.survives(point.frames++, frame_bits, Decibel{snr_db});
    point.failures += survived ? 0 : 1;
  }
  return point;
}

std::vector<LinkPoint> link_curve(Modulation modulation, CodeRate code_rate,
                                  const LinkSampling& sampling) {
  const OfdmLink link{modulation, code_rate, sampling.seed};
  LinkSampling glance = sampling;
  glance.frames = kGlance;
  glance.failures = kGlance;
  std::vector<LinkPoint> curve;
  for (int step = 0; kLowest_db + step * sampling.step_db < kHighest_db; ++step) {
    const double snr_db = kLowest_db + step * sampling.step_db;
    if (nearly_all_lost(sample_link(link, snr_db, kShortFrameBits, glance))) {
      continue;
    }
    const bool long_lost = nearly_all_lost(sample_link(link, snr_db, kLongFrameBits, glance));
    const LinkPoint point =
        sample_link(link, snr_db, long_lost ? kShortFrameBits : kLongFrameBits, sampling);
    if (point.failures < sampling.least_failures) {
      break;
    }
    curve.push_back(point);
  }
  return curve;
}

}  // namespace cuscus::netsim
