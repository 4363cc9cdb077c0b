#pragma once

#include <optional>

#include "orchestrator/results/run_directory.h"

namespace cuscus::orchestrator {

/// Who called sudo, when an ordinary user did: results are theirs. To be asked by the only thread.
[[nodiscard]] std::optional<Owner> sudo_caller();

}  // namespace cuscus::orchestrator
