#pragma once

#include <array>
#include <string>

#include "orchestrator/fetch/overpass_query.h"

namespace cuscus::orchestrator {

/// "WEST,SOUTH,EAST,NORTH". @throws UsageError naming `option`
[[nodiscard]] DegreeBox parse_degree_box(const char* option, const std::string& text);

/// "LATITUDE,LONGITUDE" as {latitude, longitude}. @throws UsageError naming `option`
[[nodiscard]] std::array<double, 2> parse_degree_pair(const char* option, const std::string& text);

}  // namespace cuscus::orchestrator
