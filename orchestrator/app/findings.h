#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/scenario/scenario.h"
#include "orchestrator/app/live_run.h"
#include "orchestrator/app/sampler.h"
#include "orchestrator/results/fidelity.h"
#include "orchestrator/results/summary.h"

namespace cuscus::orchestrator {

/// What the orchestrator itself knows of a run.
struct RunFacts {
  std::string run_id;
  std::string started_utc;
  std::chrono::nanoseconds suspended{0};
};

/// How long the host has been suspended since it started: CLOCK_BOOTTIME - CLOCK_MONOTONIC [ns].
[[nodiscard]] std::int64_t suspended_ns();

/// scenario.resolved.json: every key written out, and the versions that ran it.
[[nodiscard]] nlohmann::ordered_json resolved_scenario(const scenario::Scenario& scenario);

/// What the verdict is made from.
[[nodiscard]] FidelityInputs fidelity_inputs(const Plan& plan, const LiveRun& run,
                                             const RunFacts& facts);

/// What summary.json says; exit_code is still to be set.
[[nodiscard]] RunOutcome run_outcome(const Plan& plan, const LiveRun& run, const Sampler& sampler,
                                     const RunFacts& facts);

}  // namespace cuscus::orchestrator
