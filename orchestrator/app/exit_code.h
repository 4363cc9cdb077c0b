#pragma once

#include <stdexcept>

namespace cuscus::orchestrator {

// Exit codes of `cuscus`; 128 + n when signal n ended it.
inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitInvalid = 3;  // or not VALID, where the scenario asks for that
inline constexpr int kExitSignalBase = 128;

/// What was asked for cannot be done here, or makes no sense: nothing has been created.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace cuscus::orchestrator
