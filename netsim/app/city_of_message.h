#pragma once

#include <memory>
#include <span>
#include <string>

#include "common/city/city.h"
#include "common/city/geometry/city_geometry.h"
#include "netsim/channel/channel.h"

namespace cuscus::netsim {

/// Puts the city of a proto::CityModel's bytes in the way of radio waves, with walls as
/// `channel.walls` says; its geometry.
/// @throws std::invalid_argument naming what is wrong with the message or the name of the walls.
std::shared_ptr<const city::CityGeometry> put_city(std::span<const std::byte> message,
                                                   ChannelParameters& channel);

/// The same of a city that is there.
[[nodiscard]] std::shared_ptr<const Obstacles> obstacles_of(const city::City& city,
                                                            const ChannelParameters& channel);

}  // namespace cuscus::netsim
