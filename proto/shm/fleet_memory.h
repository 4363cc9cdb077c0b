#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"
#include "proto/shm/seqlock.h"

namespace cuscus::shm {

/// Where a node truly is. World frame W: ENU, metres; body frame B: FLU.
struct NodeState {
  std::int64_t sim_time_ns;
  std::array<double, 3> p_WB_m;
  std::array<double, 3> v_WB_W_mps;
  std::array<double, 4> q_WB;  ///< w, x, y, z; unit.
  std::array<double, 3> w_WB_B_radps;
  std::uint64_t flags;  ///< NodeFlag, or-ed.
};

/// What NodeState::flags may hold.
struct NodeFlag {
  static constexpr std::uint64_t kOnGround = 1U << 0;
  static constexpr std::uint64_t kMotorsRunning = 1U << 1;
  static constexpr std::uint64_t kCrashed = 1U << 2;  ///< Its motors do not run any more.
};

/// What the world made of the actuator commands of a node, since the run began.
struct CommandTally {
  std::uint64_t accepted;
  std::uint64_t rejected_not_finite;    ///< NaN or infinite; the command before it held on.
  std::uint64_t rejected_out_of_range;  ///< Outside 0 ... 1.
  std::uint64_t rejected_torn;          ///< Never readable as a whole.
  std::uint64_t timeouts;               ///< Times the motors stopped for want of a command.
};

/// Truth about the fleet: written by the world, read by netsim, the ground station's page and the
/// orchestrator. Slot i is radio node i.
struct FleetMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSFLEET");
  static constexpr std::uint32_t kVersion = 1;

  struct alignas(kCacheLine) Progress {
    std::atomic<std::uint64_t> steps;  ///< The world's heartbeat.
    std::atomic<std::uint64_t> overruns;
    std::atomic<std::int64_t> sim_time_ns;
  };
  struct alignas(kCacheLine) Slot {
    Seqlock<NodeState> state;
    Seqlock<CommandTally> commands;
  };

  Header header;
  Progress progress;
  // Slots follow.
};

/// The world's side.
class FleetMemoryWriter {
 public:
  [[nodiscard]] static std::size_t byte_size(std::uint32_t node_count);

  /// Lays the memory out in `memory` (page-aligned, byte_size() long), which must outlive this.
  FleetMemoryWriter(std::span<std::byte> memory, std::uint32_t node_count);

  void publish(std::uint32_t node, const NodeState& state) noexcept;
  void publish(std::uint32_t node, const CommandTally& commands) noexcept;
  void publish_progress(std::uint64_t steps, std::uint64_t overruns,
                        std::int64_t sim_time_ns) noexcept;

 private:
  FleetMemoryLayout* layout_;
  std::span<FleetMemoryLayout::Slot> slots_;
};

/// Everybody else's side; of an unlaid or foreign memory: LayoutError.
class FleetMemoryReader {
 public:
  explicit FleetMemoryReader(std::span<const std::byte> memory);

  [[nodiscard]] std::uint32_t node_count() const noexcept;
  /// Nothing when the slot was being written at every attempt. `node` < node_count().
  [[nodiscard]] std::optional<NodeState> state(std::uint32_t node) const noexcept;
  [[nodiscard]] std::optional<CommandTally> commands(std::uint32_t node) const noexcept;
  [[nodiscard]] std::uint64_t steps() const noexcept;
  [[nodiscard]] std::uint64_t overruns() const noexcept;
  [[nodiscard]] std::int64_t sim_time_ns() const noexcept;

 private:
  const FleetMemoryLayout* layout_;
  std::span<const FleetMemoryLayout::Slot> slots_;
};

}  // namespace cuscus::shm
