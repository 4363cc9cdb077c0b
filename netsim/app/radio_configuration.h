#pragma once

#include "netsim/air/air.h"
#include "proto/configuration.pb.h"

namespace cuscus::netsim {

/// The air that a scenario asks for.
/// @throws std::invalid_argument naming what is wrong and what is allowed.
[[nodiscard]] AirParameters air_parameters(const proto::RadioConfiguration& configuration);

}  // namespace cuscus::netsim
