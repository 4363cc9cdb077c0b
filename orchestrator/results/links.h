#pragma once

#include <span>
#include <string>

#include "proto/shm/radio_memory.h"

namespace cuscus::orchestrator {

/// links.csv: a row for every directed link with a count that is not 0, and for what a sender put
/// on the air for everybody, "(group)", and for nobody, "(nobody)". Node i has the name names[i].
[[nodiscard]] std::string links_csv(std::span<const std::string> names,
                                    const shm::RadioMemoryReader& radio);

}  // namespace cuscus::orchestrator
