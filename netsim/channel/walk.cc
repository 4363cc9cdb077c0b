#include "netsim/channel/walk.h"

#include <cmath>
#include <stdexcept>

namespace cuscus::netsim {
namespace {

constexpr double kMostSteps = 1e7;
/// Of a step: that the end is reached although steps do not add up to it exactly.
constexpr double kRounding = 1e-9;

std::uint64_t steps_of(const Walk& walk, double length_m) {
  if (!(walk.step_m > 0.0) || !(walk.speed_mps > 0.0)) {
    throw std::invalid_argument{"a walk's step and speed must be above 0"};
  }
  const double steps = length_m / walk.step_m;
  if (!(steps <= kMostSteps)) {
    throw std::invalid_argument{"a walk must be finite, with at most 10000000 steps"};
  }
  return static_cast<std::uint64_t>(std::floor(steps + kRounding));
}

}  // namespace

void along(const Walk& walk, const Channel& channel, const Antenna* antenna,
           const std::function<void(const WalkPoint&)>& visit) {
  const Eigen::Vector3d way = walk.p_WE - walk.p_WB;
  const double length_m = way.norm();
  const Eigen::Vector3d direction = length_m > 0.0 ? Eigen::Vector3d{way / length_m} : way;
  const std::uint64_t steps = steps_of(walk, length_m);
  for (std::uint64_t step = 0; step <= steps; ++step) {
    const double way_m = walk.step_m * static_cast<double>(step);
    const Eigen::Vector3d p_WM = walk.p_WB + way_m * direction;
    const Link link = Link::between(0, walk.p_WF, 1, p_WM);
    const auto time_ns = static_cast<std::int64_t>(way_m / walk.speed_mps * 1e9);
    visit({.way_m = way_m,
           .p_WM = p_WM,
           .distance_m = (p_WM - walk.p_WF).norm(),
           .fixed = channel.static_terms(link),
           .frame = channel.frame_terms(
               {.link = link, .from_low = false, .transmission = step, .time = sim_time(time_ns)}),
           .antennas = antenna == nullptr
                           ? Decibel{0.0}
                           : gain_of_both(*antenna, {.p_WB = walk.p_WF}, {.p_WB = p_WM})});
  }
}

}  // namespace cuscus::netsim
