#pragma once

#include <string_view>

#include "common/scenario/scenario.h"

namespace cuscus::scenario {

/// Looks on this machine for the programs that `scenario` names, as the run will:
/// absolute paths as they are, other names in `search_path` ("/usr/bin:/bin"). Executables whose
/// name has a placeholder are left to the run.
/// @throws ScenarioError with every program that is not there or not executable.
void check_programs(const Scenario& scenario, const std::string& source,
                    std::string_view search_path);

}  // namespace cuscus::scenario
