#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/scenario/scenario.h"
#include "orchestrator/plan/synthetic_runs.h"

/// The subcommands of `cuscus`. Each returns its exit code; UsageError and ScenarioError become
/// exit code 2 in main, everything else 1.
namespace cuscus::orchestrator {

/// A scenario and what the command line changes of it.
struct ScenarioArguments {
  std::filesystem::path file;
  std::optional<std::string> duration;
  std::optional<std::string> seed;
  std::optional<std::string> clock;
  std::optional<std::string> on_late;
  bool no_page{false};
  std::vector<std::string> set;  ///< PATH=VALUE
};

struct RunArguments {
  ScenarioArguments scenario;
  std::optional<std::filesystem::path> out;  ///< Else runs/<run id>.
};

/// What `cuscus air` is asked for, as it was written.
struct AirArguments {
  ScenarioArguments scenario;
  SyntheticRequest request;
  std::optional<std::string> duration;
  std::optional<std::string> period;
  std::optional<std::string> jitter;
  std::vector<std::uint32_t> nodes;          ///< Numbers of radio nodes; none: as in the scenario.
  std::optional<std::filesystem::path> out;  ///< Else standard output.
  bool plot{false};
};

/// What the command line changes of a scenario.
[[nodiscard]] std::vector<scenario::Override> overrides_of(const ScenarioArguments& arguments);

/// Loads the scenario with the command line's changes, and looks for the programs that it names.
[[nodiscard]] scenario::Scenario load(const ScenarioArguments& arguments);

int run_command(const RunArguments& arguments);
int check_command(const ScenarioArguments& arguments, bool json);
/// Simulates the scenario's radio and start positions under synthetic traffic, by cuscus-air.
int air_command(const AirArguments& arguments);
int schema_command();
int ps_command(bool json);
/// `run_id` may be empty when one run is alive.
int stop_command(const std::string& run_id);
int exec_command(const std::string& run_id, const std::string& node,
                 const std::vector<std::string>& arguments);

/// Which frames of a finished run are to be explained.
struct WhyArguments {
  std::filesystem::path run;  ///< Its directory.
  std::string sender;
  std::string receiver;
  std::string at;               ///< SimTime, such as "12.3s".
  std::string window{"100ms"};  ///< From then on.
  bool csv{false};
};
int why_command(const WhyArguments& arguments);

/// What `cuscus city` is asked for, as it was written.
struct CityArguments {
  std::vector<std::filesystem::path> files;
  std::optional<std::string> bounds;             ///< "W,S,E,N" in degrees.
  std::optional<std::string> heights;            ///< "10m..15m", of buildings without any.
  std::optional<std::filesystem::path> terrain;  ///< ESRI ASCII grid in degrees.
  std::uint64_t seed{1};
  bool json{false};
  std::optional<std::filesystem::path> out;  ///< A map: .json, .svg or .glb.
};
/// Imports a city and says what was understood of it, and what was not.
int city_command(const CityArguments& arguments);

int clean_command();
int doctor_command(std::size_t nodes);

}  // namespace cuscus::orchestrator
