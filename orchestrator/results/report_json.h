#pragma once

#include <nlohmann/json_fwd.hpp>

#include "proto/report.pb.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/radio_memory.h"

// Messages and tallies as JSON for result files; keys carry units.
namespace cuscus::orchestrator {

[[nodiscard]] nlohmann::ordered_json json_of(const proto::DurationSummary& summary);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::RadioReport& report);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::NodeServiceReport& report);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::WorldReport& report);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::CollisionTally& tally);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::AgentReport& report);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::GroundStationReport& report);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::CameraReport& report);
[[nodiscard]] nlohmann::ordered_json json_of(const proto::CameraTally& tally);
[[nodiscard]] nlohmann::ordered_json json_of(const shm::RadioTally& tally);
[[nodiscard]] nlohmann::ordered_json json_of(const shm::CommandTally& tally);

}  // namespace cuscus::orchestrator
