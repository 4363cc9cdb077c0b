#pragma once

#include <optional>
#include <span>

#include "common/scenario/scenario.h"
#include "orchestrator/plan/plan.h"
#include "proto/configuration.pb.h"

namespace cuscus::orchestrator {

/// What the camera process is told of a run of `scenario` with `nodes`; nothing when no vehicle has
/// a camera.
[[nodiscard]] std::optional<proto::CameraConfiguration> camera_configuration(
    const scenario::Scenario& scenario, std::span<const NodePlan> nodes);

}  // namespace cuscus::orchestrator
