#pragma once

#include <filesystem>

namespace cuscus::orchestrator {

/// Under sudo, makes a folder and all in it the property of the user who called sudo.
void give_to_caller(const std::filesystem::path& folder);

}  // namespace cuscus::orchestrator
