#pragma once

#include <cstdint>
#include <vector>

#include "netsim/air/air.h"
#include "proto/shm/fleet_memory.h"

namespace cuscus::netsim {

/// Positions and attitudes as the world writes them. A slot that cannot be read keeps its last
/// ones.
class FleetPositions final : public PositionSource {
 public:
  /// `fleet` must outlive this object.
  /// @throws std::invalid_argument when it has fewer than `nodes` nodes.
  FleetPositions(const shm::FleetMemoryReader& fleet, std::uint32_t nodes);

  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions(SimTime now) override;
  [[nodiscard]] std::span<const Eigen::Quaterniond> attitudes() const override { return q_WB_; }
  [[nodiscard]] std::uint64_t version() const override { return version_; }

  /// Slots that were being written at every attempt to read them.
  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }

 private:
  const shm::FleetMemoryReader* fleet_;
  std::vector<Eigen::Vector3d> p_WB_;
  std::vector<Eigen::Quaterniond> q_WB_;
  SimTime read_at_{};
  std::uint64_t steps_{0};
  std::uint64_t version_{1};
  std::uint64_t unreadable_{0};
};

}  // namespace cuscus::netsim
