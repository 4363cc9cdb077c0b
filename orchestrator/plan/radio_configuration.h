#pragma once

#include <cstdint>

#include "common/scenario/scenario.h"
#include "proto/configuration.pb.h"

namespace cuscus::orchestrator {

/// What the emulator is told of the air, but for the nodes in it and how they are attached.
[[nodiscard]] proto::RadioConfiguration radio_configuration(const scenario::Radio& from,
                                                            std::uint64_t seed);

}  // namespace cuscus::orchestrator
