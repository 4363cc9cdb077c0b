#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/scenario/programs.h"
#include "orchestrator/app/city_source.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {

std::vector<scenario::Override> overrides_of(const ScenarioArguments& arguments) {
  std::vector<scenario::Override> overrides;
  const auto add = [&](const char* key, const std::optional<std::string>& value) {
    if (value) {
      overrides.push_back(
          {.option = fmt::format("--{} {}", key, *value), .path = key, .value = *value});
    }
  };
  add("duration", arguments.duration);
  add("seed", arguments.seed);
  add("clock", arguments.clock);
  if (arguments.on_late) {
    overrides.push_back({.option = "--on-late " + *arguments.on_late,
                         .path = "on_late",
                         .value = *arguments.on_late});
  }
  if (arguments.no_page) {
    overrides.push_back({.option = "--no-page", .path = "ground_station.page", .value = "none"});
  }
  for (const auto& text : arguments.set) {
    overrides.push_back(scenario::parse_override(text));
  }
  return overrides;
}

scenario::Scenario load(const ScenarioArguments& arguments) {
  auto scenario = scenario::load_scenario(arguments.file, overrides_of(arguments));
  scenario::check_programs(scenario, arguments.file.native(), kProgramPath);
  return scenario;
}

int check_command(const ScenarioArguments& arguments, bool json) {
  const scenario::Scenario scenario = load(arguments);
  static_cast<void>(load_city(scenario));
  const Plan plan = make_plan(scenario);
  if (json) {
    fmt::print("{}\n", to_json(plan).dump(2));
  } else {
    fmt::print("{}", to_text(plan));
  }
  return kExitDone;
}

int schema_command() {
  fmt::print("{}", scenario::scenario_schema());
  return kExitDone;
}

}  // namespace cuscus::orchestrator
