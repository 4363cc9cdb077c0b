#pragma once

#include <string>

#include "common/posix/unique_fd.h"
#include "common/scenario/scenario.h"

namespace cuscus::orchestrator {

/// The city of a scenario, from its file or made by its generator, as the bytes of a
/// proto::CityModel; empty when there is none. Says on standard error what it has understood.
/// @throws UsageError naming the file and the cause.
[[nodiscard]] std::string load_city(const scenario::Scenario& scenario);

/// Such bytes in a sealed memory file, for the programs of a run; empty when they are.
[[nodiscard]] posix::UniqueFd city_memory(const std::string& message);

}  // namespace cuscus::orchestrator
