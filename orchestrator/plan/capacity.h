#pragma once

#include <cstdint>

#include "common/scenario/scenario.h"
#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {

/// What the beacons and the telemetry of `scenario` will cost. docs/scenario.md has the figures
/// that it multiplies and where they come from.
[[nodiscard]] CapacityEstimate estimate_capacity(const scenario::Scenario& scenario);

}  // namespace cuscus::orchestrator
