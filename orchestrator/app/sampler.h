#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "orchestrator/app/live_run.h"
#include "orchestrator/results/formation_error.h"
#include "orchestrator/results/metrics.h"
#include "orchestrator/results/summary.h"

namespace cuscus::orchestrator {

/// Looks at the truth every metrics period: rows for metrics.csv, formation errors for the summary.
class Sampler {
 public:
  Sampler(const Plan& plan, const LiveRun& run, MetricsWriter& metrics);

  void sample(double sim_time_s);

  /// Formation error of `node` in the second half of the flight, when the fleet has had time to
  /// form up; nothing when it has no formation.
  [[nodiscard]] std::optional<FormationErrorSummary> formation_error(std::uint32_t node) const;
  /// The same of all UAVs together.
  [[nodiscard]] std::optional<FormationErrorSummary> formation_error() const;

 private:
  /// UAVs that fly one circle together.
  struct Formation {
    FormationCircle circle;
    std::vector<std::uint32_t> nodes;  // by slot
  };

  void measure(const Formation& formation);

  const Plan& plan_;
  const LiveRun& run_;
  MetricsWriter& metrics_;
  std::vector<Formation> formations_;
  std::vector<std::optional<shm::NodeState>> states_;  // by node, of the sample at hand
  std::vector<std::optional<double>> errors_m_;        // likewise
  std::vector<std::vector<double>> settled_errors_m_;  // by node, of the second half
};

}  // namespace cuscus::orchestrator
