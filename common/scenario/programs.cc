#include "common/scenario/programs.h"

#include <unistd.h>

#include <optional>
#include <utility>

#include "common/scenario/scenario_error.h"

namespace cuscus::scenario {
namespace {

bool is_executable(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

bool is_in(std::string_view search_path, const std::string& name) {
  while (!search_path.empty()) {
    const std::size_t colon = search_path.find(':');
    const std::string_view folder = search_path.substr(0, colon);
    if (!folder.empty() && is_executable(std::filesystem::path{folder} / name)) {
      return true;
    }
    search_path.remove_prefix(colon == std::string_view::npos ? search_path.size() : colon + 1);
  }
  return false;
}

/// What is wrong with a program; nothing when it is there, or known only in the run.
std::optional<std::string> trouble_with(const std::vector<std::string>& program,
                                        std::string_view search_path) {
  if (program.empty() || program.front().find('{') != std::string::npos) {
    return std::nullopt;
  }
  const std::string& name = program.front();
  if (name.front() == '/' && !is_executable(name)) {
    return '"' + name + "\" is not there or not executable; allowed: an executable file";
  }
  if (name.front() != '/' && !is_in(search_path, name)) {
    return '"' + name + "\" is not in " + std::string{search_path} +
           "; allowed: a program in one of these folders, or a path with a '/'";
  }
  return std::nullopt;
}

}  // namespace

void check_programs(const Scenario& scenario, const std::string& source,
                    std::string_view search_path) {
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    for (const auto& [key, program] :
         {std::pair{"agent", &group.agent}, {"command", &group.command}}) {
      if (const auto trouble = trouble_with(*program, search_path)) {
        problems.push_back({source, "/fleet/" + std::to_string(i) + '/' + key + "/0", *trouble});
      }
    }
  }
  if (!problems.empty()) {
    throw ScenarioError{problems};
  }
}

}  // namespace cuscus::scenario
