#pragma once

#include "proto/configuration.pb.h"
#include "uav-agent/flight/airframe.h"
#include "uav-agent/flight/autopilot.h"
#include "uav-agent/missions/circle_law.h"

namespace cuscus::agent {

/// Throws std::invalid_argument naming the field when `configuration` cannot be flown.
void check(const proto::AgentConfiguration& configuration);

/// Fields that are not given keep FL-AIR's values.
[[nodiscard]] flight::Airframe airframe(const proto::AgentConfiguration& configuration);

/// The autopilot's parameters: sensors as the scenario has them.
[[nodiscard]] flight::AutopilotParameters autopilot_parameters(
    const proto::AgentConfiguration& configuration);

[[nodiscard]] missions::CircleParameters circle(const proto::AgentConfiguration& configuration);

}  // namespace cuscus::agent
