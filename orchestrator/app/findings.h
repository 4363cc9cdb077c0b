#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
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
  std::chrono::nanoseconds longest_gap{0};  ///< Between two looks at the run.
  std::optional<std::chrono::steady_clock::time_point> last_look{};

  /// Called at every look.
  void note_supervision() {
    const auto now = std::chrono::steady_clock::now();
    if (last_look) {
      longest_gap = std::max(longest_gap, std::chrono::nanoseconds{now - *last_look});
    }
    last_look = now;
  }
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
