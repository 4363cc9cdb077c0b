#include "netsim/app/fleet_positions.h"

#include <stdexcept>
#include <string>

namespace cuscus::netsim {

FleetPositions::FleetPositions(const shm::FleetMemoryReader& fleet, std::uint32_t nodes)
    : fleet_{&fleet},
      p_WB_(nodes, Eigen::Vector3d::Zero()),
      q_WB_(nodes, Eigen::Quaterniond::Identity()) {
  if (fleet.node_count() < nodes) {
    throw std::invalid_argument{"fleet memory has " + std::to_string(fleet.node_count()) +
                                " nodes and the radio " + std::to_string(nodes)};
  }
}

const std::vector<Eigen::Vector3d>& FleetPositions::positions(SimTime now) {
  if (now == read_at_ && version_ > 1) {
    return p_WB_;
  }
  read_at_ = now;
  const std::uint64_t steps = fleet_->steps();
  if (steps == steps_ && version_ > 1) {
    return p_WB_;
  }
  steps_ = steps;
  for (std::uint32_t node = 0; node < p_WB_.size(); ++node) {
    const auto state = fleet_->state(node);
    const bool finite = state && Eigen::Vector3d{state->p_WB_m.data()}.allFinite();
    if (!finite) {
      ++unreadable_;
      continue;
    }
    p_WB_[node] = Eigen::Vector3d{state->p_WB_m.data()};
    const auto& [w, x, y, z] = state->q_WB;
    const Eigen::Quaterniond q_WB{w, x, y, z};
    if (q_WB.coeffs().allFinite() && q_WB.norm() > 0.0) {
      q_WB_[node] = q_WB.normalized();
    }
  }
  ++version_;
  return p_WB_;
}

}  // namespace cuscus::netsim
