#include "netsim/app/city_of_message.h"

#include <stdexcept>
#include <utility>

#include "common/city/transfer/city_message.h"
#include "netsim/channel/city_obstacles.h"

namespace cuscus::netsim {
namespace {

WallLosses walls_of(const ChannelParameters& channel) {
  if (channel.walls == "paper") {
    return paper_walls(channel.carrier_hz);
  }
  if (channel.walls == "p2040") {
    return p2040_walls(channel.carrier_hz);
  }
  throw std::invalid_argument{"walls '" + channel.walls + "'; allowed are 'paper', 'p2040'"};
}

}  // namespace

std::shared_ptr<const Obstacles> obstacles_of(const city::City& city,
                                              const ChannelParameters& channel) {
  const WallLosses walls = walls_of(channel);
  return std::make_shared<CityObstacles>(city, std::make_shared<const city::CityGeometry>(city),
                                         walls);
}

std::shared_ptr<const city::CityGeometry> put_city(std::span<const std::byte> message,
                                                   ChannelParameters& channel) {
  const WallLosses walls = walls_of(channel);  // what is wrong with them comes first
  const city::City city = city::from_bytes(message);
  auto geometry = std::make_shared<const city::CityGeometry>(city);
  channel.city = std::make_shared<CityObstacles>(city, geometry, walls);
  return geometry;
}

}  // namespace cuscus::netsim
