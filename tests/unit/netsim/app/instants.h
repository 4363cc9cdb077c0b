#pragma once

#include <chrono>
#include <cstdint>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

[[nodiscard]] inline SimTime at_us(std::int64_t us) {
  return SimTime{std::chrono::microseconds{us}};
}

}  // namespace cuscus::netsim
