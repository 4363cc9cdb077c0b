#include "netsim/app/city_of_message.h"

#include <limits>
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

void put_city(std::span<const std::byte> message, ChannelParameters& channel) {
  const WallLosses walls = walls_of(channel);
  proto::CityModel model;
  if (message.size() > std::numeric_limits<int>::max() ||
      !model.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
    throw std::invalid_argument{"a city of " + std::to_string(message.size()) +
                                " B is no message of cuscus"};
  }
  const city::City city = city::from_message(model);
  channel.city =
      std::make_shared<CityObstacles>(city, std::make_shared<city::CityGeometry>(city), walls);
}

}  // namespace cuscus::netsim
