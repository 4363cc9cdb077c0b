#include "orchestrator/app/run_registry.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/posix/check.h"
#include "orchestrator/results/run_directory.h"

namespace cuscus::orchestrator {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using posix::check;
using posix::UniqueFd;

constexpr auto kLockName = "lock";
constexpr auto kStateName = "run.json";

json to_json(const RegisteredRun& run) {
  json nodes = json::array();
  for (const auto& node : run.nodes) {
    nodes.push_back({{"name", node.name}, {"address", node.address}, {"init_pid", node.init_pid}});
  }
  return {{"run_id", run.run_id},
          {"pid", run.pid},
          {"scenario", run.scenario},
          {"results", run.results},
          {"started_unix_s", run.started_unix_s},
          {"nodes", nodes}};
}

RegisteredRun from_json(const json& value) {
  RegisteredRun run{.run_id = value.at("run_id"),
                    .pid = value.at("pid"),
                    .scenario = value.at("scenario"),
                    .results = value.at("results"),
                    .started_unix_s = value.at("started_unix_s"),
                    .nodes = {}};
  for (const auto& node : value.at("nodes")) {
    run.nodes.push_back(
        {.name = node.at("name"), .address = node.at("address"), .init_pid = node.at("init_pid")});
  }
  return run;
}

/// The registry's folder, locked until the descriptor goes; nothing when there is none. Who adds or
/// removes entries has it alone (LOCK_EX), so that nobody takes an entry in the making for a dead
/// one; who reads shares it (LOCK_SH).
/// @throws std::system_error when it is somebody else's.
UniqueFd lock_registry(const fs::path& folder, int operation) {
  UniqueFd registry{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
  if (!registry && errno == ENOENT) {
    return registry;
  }
  const std::string attempt = "open the run registry " + folder.native();
  if (!registry) {
    posix::throw_errno(attempt);
  }
  struct stat status {};
  check("fstat of the run registry", ::fstat(registry.get(), &status));
  if (status.st_uid != ::geteuid()) {
    errno = EPERM;
    posix::throw_errno(folder.native() + " is not a folder of this user's");
  }
  int result = -1;
  while ((result = ::flock(registry.get(), operation)) != 0 && errno == EINTR) {
  }
  check("lock the run registry", result);
  return registry;
}

/// Whether a living process holds the entry's lock.
bool is_alive(const fs::path& entry) {
  const UniqueFd lock{::open((entry / kLockName).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  return lock && ::flock(lock.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

std::optional<RegisteredRun> read_entry(const fs::path& entry) {
  std::ifstream file{entry / kStateName};
  const json value = json::parse(file, nullptr, false);
  return value.is_discarded() ? std::nullopt : std::optional{from_json(value)};
}

/// The entries there are, alive or not; none when the folder does not exist.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator{folder, error}) {
    if (entry.is_directory() && !entry.is_symlink()) {
      entries.push_back(entry.path());
    }
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

RegistryEntry::RegistryEntry(fs::path folder, UniqueFd lock)
    : folder_{std::move(folder)}, lock_{std::move(lock)} {}

RegistryEntry::~RegistryEntry() {
  if (!lock_) {
    return;
  }
  try {
    const UniqueFd registry = lock_registry(folder_.parent_path(), LOCK_EX);
    fs::remove_all(folder_);
  } catch (const std::exception&) {
    return;  // the next start sweeps what cannot be removed now
  }
}

void RegistryEntry::publish(const RegisteredRun& run) const {
  const fs::path draft = folder_ / "run.json.new";
  {
    const UniqueFd file{
        check("make the run's state",
              ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644))};
    write_all(file.get(), to_json(run).dump(2) + '\n');
  }
  fs::rename(draft, folder_ / kStateName);
}

fs::path RunRegistry::default_folder() {
  if (::geteuid() == 0) {
    return "/run/cuscus";
  }
  // Read before any thread exists.
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");  // NOLINT(concurrency-mt-unsafe)
  return runtime != nullptr && *runtime != '\0'
             ? fs::path{runtime} / "cuscus"
             : fs::temp_directory_path() / ("cuscus-" + std::to_string(::geteuid()));
}

RegistryEntry RunRegistry::enter(const RegisteredRun& run) const {
  fs::create_directories(folder_);
  const UniqueFd registry = lock_registry(folder_, LOCK_EX);
  const fs::path entry = folder_ / run.run_id;
  check("make the run's entry", ::mkdir(entry.c_str(), 0755));
  UniqueFd lock{check("make the run's lock", ::open((entry / kLockName).c_str(),
                                                    O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644))};
  check("lock the run's entry", ::flock(lock.get(), LOCK_EX | LOCK_NB));
  RegistryEntry held{entry, std::move(lock)};
  try {
    held.publish(run);
  } catch (const std::exception&) {
    // Here, since `held` would wait for the registry's lock, which is ours.
    std::error_code ignored;
    fs::remove_all(entry, ignored);
    held.lock_.reset();
    throw;
  }
  return held;
}

std::vector<RegisteredRun> RunRegistry::runs() const {
  std::vector<RegisteredRun> alive;
  const UniqueFd registry = lock_registry(folder_, LOCK_SH);
  if (!registry) {
    return alive;  // a folder made just now would be looked at without its lock
  }
  for (const auto& entry : entries_of(folder_)) {
    if (!is_alive(entry)) {
      continue;
    }
    if (auto run = read_entry(entry)) {
      alive.push_back(std::move(*run));
    }
  }
  return alive;
}

std::vector<std::string> RunRegistry::sweep() const {
  std::vector<std::string> removed;
  const UniqueFd registry = lock_registry(folder_, LOCK_EX);
  if (!registry) {
    return removed;  // the same
  }
  for (const auto& entry : entries_of(folder_)) {
    if (!is_alive(entry)) {
      std::error_code error;  // what cannot be removed now is left for the next sweep
      fs::remove_all(entry, error);
      if (!error) {
        removed.push_back(entry.filename());
      }
    }
  }
  return removed;
}

}  // namespace cuscus::orchestrator
