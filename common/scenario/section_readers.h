#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/scenario/object_reader.h"
#include "common/scenario/scenario.h"

// The sections of a scenario file. `value` is null when the section is absent. What is wrong goes
// to `problems`.
namespace cuscus::scenario {

[[nodiscard]] Radio read_radio(const nlohmann::json* value, const std::filesystem::path& folder,
                               Problems& problems);
[[nodiscard]] Antenna read_antenna(const nlohmann::json* value, const std::string& path,
                                   const std::filesystem::path& folder, Problems& problems);
[[nodiscard]] Propagation read_propagation(const nlohmann::json* value, const std::string& path,
                                           Problems& problems);
[[nodiscard]] std::optional<Shadowing> read_shadowing(const nlohmann::json* value,
                                                      const std::string& path, Problems& problems);
[[nodiscard]] Fading read_fading(const nlohmann::json* value, const std::string& path,
                                 Problems& problems);
[[nodiscard]] Mac read_mac(const nlohmann::json* value, const std::string& path,
                           RadioStandard standard, Problems& problems);
[[nodiscard]] std::optional<Disruption> read_disruption(const nlohmann::json* value,
                                                        const std::string& path,
                                                        Problems& problems);
[[nodiscard]] std::vector<BoxObstacle> read_obstacles(const nlohmann::json* value,
                                                      const std::string& path, Problems& problems);
[[nodiscard]] std::vector<Jammer> read_jammers(const nlohmann::json* value, const std::string& path,
                                               Problems& problems);
/// Nothing: there is none.
[[nodiscard]] std::optional<CitySection> read_city(const nlohmann::json* value,
                                                   const std::filesystem::path& folder,
                                                   Problems& problems);
[[nodiscard]] Network read_network(const nlohmann::json* value, Problems& problems);
[[nodiscard]] World read_world(const nlohmann::json* value, Problems& problems);
[[nodiscard]] GroundStation read_ground_station(const nlohmann::json* value, Problems& problems);
[[nodiscard]] Record read_record(const nlohmann::json* value, Problems& problems);
[[nodiscard]] Vehicle read_vehicle(const nlohmann::json* value, const std::string& path,
                                   Problems& problems);
[[nodiscard]] std::vector<Group> read_fleet(const nlohmann::json* value,
                                            const std::filesystem::path& folder,
                                            Problems& problems);

/// What no section can know alone: limits of the whole fleet, addresses, ports, placeholders. Call
/// it only with a scenario whose sections had no problems.
void check_whole(const Scenario& scenario, Problems& problems);

/// Holds `document` against the JSON schema, as a second pair of eyes.
void check_against_schema(const nlohmann::json& document, Problems& problems);

}  // namespace cuscus::scenario
