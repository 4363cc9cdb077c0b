#include "world/actuation/command_gate.h"

#include <algorithm>
#include <cmath>

namespace cuscus::world {

void CommandGate::offer(SimTime now, const std::optional<shm::ActuatorCommand>& command) {
  if (!command) {
    ++tally_.rejected_torn;
    return;
  }
  if (command->sequence == 0 || command->sequence == accepted_sequence_) {
    return;
  }
  const Motors& motors = command->motors;
  if (!std::all_of(motors.begin(), motors.end(), [](double u) { return std::isfinite(u); })) {
    ++tally_.rejected_not_finite;
    return;
  }
  if (!std::all_of(motors.begin(), motors.end(), [](double u) { return u >= 0.0 && u <= 1.0; })) {
    ++tally_.rejected_out_of_range;
    return;
  }
  ++tally_.accepted;
  motors_ = motors;
  driven_ = true;
  accepted_at_ = now;
  accepted_sequence_ = command->sequence;
}

void CommandGate::expire(SimTime now) {
  if (driven_ && now - accepted_at_ >= motor_timeout_) {
    ++tally_.timeouts;
    motors_.fill(0.0);
    driven_ = false;
  }
}

}  // namespace cuscus::world
