#pragma once

#include <filesystem>
#include <string>

#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {

/// The scenarios that are shipped.
inline const std::filesystem::path kFolder{CUSCUS_SCENARIO_FOLDER};

inline scenario::Scenario parse(const std::string& text) {
  return scenario::parse_scenario(text, "flight.json", "/scenarios");
}

inline Plan plan_of(const std::string& text) { return make_plan(parse(text)); }

}  // namespace cuscus::orchestrator
