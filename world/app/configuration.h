#pragma once

#include <cstdint>

#include "proto/configuration.pb.h"
#include "world/dynamics/multirotor_parameters.h"

namespace cuscus::world {

/// @throws std::invalid_argument naming node, value and what is allowed, when the world cannot run
/// what it is told.
void check_configuration(const proto::WorldConfiguration& configuration);

/// How many slots fleet memory has: one for every node up to the highest number.
[[nodiscard]] std::uint32_t slot_count(const proto::WorldConfiguration& configuration);

[[nodiscard]] MultirotorParameters parameters_of(const proto::MultirotorParameters& message);

}  // namespace cuscus::world
