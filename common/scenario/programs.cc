#include "common/scenario/programs.h"

#include <unistd.h>

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

}  // namespace

void check_programs(const Scenario& scenario, const std::string& source,
                    std::string_view search_path) {
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    if (scenario.fleet[i].command.empty()) {
      continue;
    }
    const std::string& name = scenario.fleet[i].command.front();
    if (name.find('{') != std::string::npos) {
      continue;
    }
    const std::string path = "/fleet/" + std::to_string(i) + "/command/0";
    if (name.front() == '/' && !is_executable(name)) {
      problems.push_back({source, path,
                          '"' + name +
                              "\" is not there or not executable; allowed: "
                              "an executable file"});
    } else if (name.front() != '/' && !is_in(search_path, name)) {
      problems.push_back({source, path,
                          '"' + name + "\" is not in " + std::string{search_path} +
                              "; allowed: a program in one of these folders, or a "
                              "path with a '/'"});
    }
  }
  if (!problems.empty()) {
    throw ScenarioError{problems};
  }
}

}  // namespace cuscus::scenario
