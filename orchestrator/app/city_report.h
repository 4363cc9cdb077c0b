#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/city/import/import_city.h"

namespace cuscus::orchestrator {

/// What `cuscus city FILE` prints: what was understood, and what was dropped and why.
[[nodiscard]] std::string city_text(const city::ImportedCity& imported);

/// The same for programs; its keys are documented in docs/city.md.
[[nodiscard]] nlohmann::ordered_json city_json(const city::ImportedCity& imported);

}  // namespace cuscus::orchestrator
