#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "orchestrator/node/node.h"

namespace cuscus::test {

/// `count` nodes uav0, uav1, ... with addresses 10.0.0.1/16 upwards.
[[nodiscard]] inline std::vector<node::NodeNetwork> test_fleet(std::size_t count,
                                                               node::Attachment attachment) {
  std::vector<node::NodeNetwork> networks;
  for (std::uint32_t index = 0; index < count; ++index) {
    const auto high = static_cast<std::uint8_t>((index + 1) >> 8U);
    const auto low = static_cast<std::uint8_t>((index + 1) & 0xFFU);
    networks.push_back({.index = index,
                        .name = "uav" + std::to_string(index),
                        .mac = {2, 0, 0, 0, high, low},
                        .address = {.address = {10, 0, high, low}, .length = 16},
                        .attachment = attachment});
  }
  return networks;
}

}  // namespace cuscus::test
