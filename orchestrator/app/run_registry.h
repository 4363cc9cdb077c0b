#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/posix/unique_fd.h"

namespace cuscus::orchestrator {

/// One node of a run, as other commands need to know it.
struct RegisteredNode {
  std::string name;
  std::string address;
  pid_t init_pid;  ///< In the PID namespace of the orchestrator.
};

/// A run that is alive.
struct RegisteredRun {
  std::string run_id;
  pid_t pid;  ///< Of its orchestrator.
  std::string scenario;
  std::string results;
  std::int64_t started_unix_s;
  std::vector<RegisteredNode> nodes;
};

/// A run's entry in the registry; it is removed when this object goes.
class RegistryEntry {
 public:
  RegistryEntry(RegistryEntry&&) = default;
  RegistryEntry& operator=(RegistryEntry&&) = delete;
  RegistryEntry(const RegistryEntry&) = delete;
  RegistryEntry& operator=(const RegistryEntry&) = delete;
  ~RegistryEntry();

  /// Replaces what others see of the run. @throws std::system_error; they then see the old state.
  void publish(const RegisteredRun& run) const;

 private:
  friend class RunRegistry;
  RegistryEntry(std::filesystem::path folder, posix::UniqueFd lock);

  std::filesystem::path folder_;
  posix::UniqueFd lock_;
};

/// The runs of this machine: one folder each, with a lock that its orchestrator holds. The kernel
/// drops the lock when the orchestrator dies, however it dies, so an entry whose lock is free is
/// what a killed run has left behind, and nothing else is ever removed.
class RunRegistry {
 public:
  /// /run/cuscus for root, a folder of the user's otherwise.
  [[nodiscard]] static std::filesystem::path default_folder();

  explicit RunRegistry(std::filesystem::path folder) : folder_{std::move(folder)} {}

  /// Enters a run and locks its entry.
  /// @throws std::system_error when the entry exists or cannot be made, as do all three when the
  /// folder is somebody else's.
  [[nodiscard]] RegistryEntry enter(const RegisteredRun& run) const;

  /// The runs whose orchestrator lives, by run id.
  [[nodiscard]] std::vector<RegisteredRun> runs() const;

  /// Removes the entries of dead runs; returns their ids.
  [[nodiscard]] std::vector<std::string> sweep() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace cuscus::orchestrator
