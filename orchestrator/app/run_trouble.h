#pragma once

#include <stdexcept>

namespace cuscus::orchestrator {

// What ends a run before its time.

struct RunFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// By a signal.
struct RunInterrupted {};
/// It is late, and the scenario wants no such run.
struct RunLate : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace cuscus::orchestrator
