#pragma once

#include <cstddef>
#include <span>

#include "common/city/city.h"
#include "proto/city.pb.h"

namespace cuscus::city {

/// A run's city in its results, as a message.
inline constexpr const char* kCityFile = "city.pb";

/// The same city as a message.
[[nodiscard]] proto::CityModel to_message(const City& city);

/// The city in a message.
/// @throws std::invalid_argument naming what is wrong in a message that to_message() cannot have
/// made.
[[nodiscard]] City from_message(const proto::CityModel& message);
/// The same of its bytes.
[[nodiscard]] City from_bytes(std::span<const std::byte> message);

}  // namespace cuscus::city
