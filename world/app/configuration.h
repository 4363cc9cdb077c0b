#pragma once

#include <cstdint>

#include "common/city/city.h"
#include "proto/configuration.pb.h"
#include "world/collision/collision_body.h"
#include "world/dynamics/multirotor_parameters.h"
#include "world/sensors/gnss.h"
#include "world/sensors/lidar.h"
#include "world/sensors/ultrasonic.h"

namespace cuscus::world {

/// @throws std::invalid_argument naming node, value and what is allowed, when the world cannot run
/// what it is told.
void check_configuration(const proto::WorldConfiguration& configuration);

/// How many slots fleet memory has: one for every node up to the highest number.
[[nodiscard]] std::uint32_t slot_count(const proto::WorldConfiguration& configuration);

[[nodiscard]] MultirotorParameters parameters_of(const proto::MultirotorParameters& message);

[[nodiscard]] UltrasonicParameters parameters_of(const proto::UltrasonicConfiguration& message);
[[nodiscard]] LidarParameters parameters_of(const proto::LidarConfiguration& message);
[[nodiscard]] GnssParameters parameters_of(const proto::GnssConfiguration& message);

/// Where on Earth the origin is when no city tells it.
[[nodiscard]] city::Geodetic site_of(const proto::WorldConfiguration& configuration);

/// What of a vehicle hits and is hit; without a word about it a point, which meets no others.
[[nodiscard]] CollisionBody collision_body_of(const proto::WorldNode& node);

}  // namespace cuscus::world
