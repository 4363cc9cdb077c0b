#pragma once

#include <string>
#include <vector>

#include "common/city/city.h"
#include "common/posix/unique_fd.h"
#include "common/scenario/scenario.h"

namespace cuscus::orchestrator {

/// A scenario's city, from its file or made by its generator.
struct LoadedCity {
  city::City city;
  std::string summary;               ///< "1318 buildings up to 443.2 m, ..."
  std::vector<std::string> remarks;  ///< What to know before trusting it.
};

/// Of a scenario that has one.
/// @throws city::CityFileError naming the file and the cause.
[[nodiscard]] LoadedCity load_city(const scenario::Scenario& scenario);

/// The city in a sealed memory file, for the programs of a run.
[[nodiscard]] posix::UniqueFd city_memory(const std::string& message);

}  // namespace cuscus::orchestrator
