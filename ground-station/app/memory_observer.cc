#include "ground-station/app/memory_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cuscus::gcs {
namespace {

bool is_finite(const std::array<double, 3>& vector) {
  return std::all_of(vector.begin(), vector.end(), [](double x) { return std::isfinite(x); });
}

/// Heading of the body's forward axis, counter-clockwise from east [rad].
double yaw_rad(const std::array<double, 4>& q_WB) {
  const auto [w, x, y, z] = q_WB;
  return std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

std::optional<Observation::Truth> truth_of(const std::optional<shm::NodeState>& state) {
  // A slot that nobody has written yet holds zeros, which are no rotation.
  if (!state || state->q_WB == std::array<double, 4>{} || !is_finite(state->p_WB_m) ||
      !is_finite(state->v_WB_W_mps)) {
    return std::nullopt;
  }
  return Observation::Truth{.p_WB_m = state->p_WB_m,
                            .v_WB_W_mps = state->v_WB_W_mps,
                            .yaw_rad = yaw_rad(state->q_WB),
                            .on_ground = (state->flags & shm::NodeFlag::kOnGround) != 0,
                            .motors_running = (state->flags & shm::NodeFlag::kMotorsRunning) != 0};
}

}  // namespace

MemoryObserver::MemoryObserver(const posix::UniqueFd& fleet, const posix::UniqueFd& radio)
    : fleet_mapping_{posix::MemoryMapping::read_only(fleet)},
      radio_mapping_{posix::MemoryMapping::read_only(radio)},
      fleet_{fleet_mapping_.bytes()},
      radio_{radio_mapping_.bytes()} {}

Observation MemoryObserver::observe() const {
  Observation result;
  for (std::uint32_t node = 0; node < fleet_.node_count(); ++node) {
    result.truth.push_back(truth_of(fleet_.state(node)));
  }
  const std::uint32_t radios = radio_.node_count();
  for (std::uint32_t receiver = 0; receiver < radios; ++receiver) {
    result.tallies.push_back(radio_.tally(receiver));
    for (std::uint32_t sender = 0; sender < radios; ++sender) {
      if (const auto reading = radio_.link(receiver, sender)) {
        result.links.push_back({.sender = sender,
                                .receiver = receiver,
                                .received_dbm = reading->received_dbm,
                                .rate_kbps = reading->rate_kbps,
                                .heard = SimTime{std::chrono::milliseconds{reading->sim_time_ms}}});
      }
    }
  }
  result.world = Observation::World{.steps = fleet_.steps(),
                                    .overruns = fleet_.overruns(),
                                    .reached = sim_time(fleet_.sim_time_ns())};
  result.radio =
      Observation::Radio{.timing = radio_.timing(), .reached = sim_time(radio_.sim_time_ns())};
  return result;
}

}  // namespace cuscus::gcs
