#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/units/sim_time.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/vehicle_memory.h"

namespace cuscus::world {

/// What stands between an agent's commands and the motors of its vehicle: trusts nothing.
///
/// A command counts when it is new (another sequence number than the last accepted one, and not 0)
/// and all its motors are finite and within 0 ... 1; else the command before it holds on and the
/// tally says why. Without an accepted command for the timeout the motors stop, until the next one.
class CommandGate {
 public:
  using Motors = decltype(shm::ActuatorCommand::motors);

  /// Motors stand still until the first command.
  explicit CommandGate(SimClock::duration motor_timeout) : motor_timeout_{motor_timeout} {}

  /// Judges what was read at `now`; nothing means that it could not be read as a whole.
  void offer(SimTime now, const std::optional<shm::ActuatorCommand>& command);

  /// Stops the motors when the last accepted command is too old at `now`.
  void expire(SimTime now);

  /// What the motors do.
  [[nodiscard]] const Motors& motors() const { return motors_; }
  /// Whether a command drives the motors: one was accepted and has not expired.
  [[nodiscard]] bool driven() const { return driven_; }
  [[nodiscard]] const shm::CommandTally& tally() const { return tally_; }

 private:
  SimClock::duration motor_timeout_;
  Motors motors_{};
  bool driven_{false};
  SimTime accepted_at_{};
  std::uint64_t accepted_sequence_{0};
  shm::CommandTally tally_{};
};

}  // namespace cuscus::world
