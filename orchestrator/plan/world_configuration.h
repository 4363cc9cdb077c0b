#pragma once

#include <span>

#include "common/scenario/scenario.h"
#include "orchestrator/plan/plan.h"
#include "proto/configuration.pb.h"

namespace cuscus::orchestrator {

/// What the world is told of a run of `scenario` with `nodes`, but for its priority.
[[nodiscard]] proto::WorldConfiguration world_configuration(const scenario::Scenario& scenario,
                                                            std::span<const NodePlan> nodes);

[[nodiscard]] proto::MultirotorParameters parameters_of(const scenario::X4Vehicle& x4);
[[nodiscard]] proto::Vector3 vector_of(const scenario::Position_m& p_m);

}  // namespace cuscus::orchestrator
