#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "common/posix/unique_fd.h"

namespace cuscus::orchestrator {

/// A name for a run that no other run has: "default-20260131T120000Z-3f9a1c", from the scenario's
/// name, the time and 24 random bits.
[[nodiscard]] std::string make_run_id(const std::string& scenario_name,
                                      std::chrono::system_clock::time_point now,
                                      std::uint32_t random_bits);

/// "2026-01-31T12:00:00Z"
[[nodiscard]] std::string utc_text(std::chrono::system_clock::time_point time);

/// Whom files belong to.
struct Owner {
  uid_t uid{};
  gid_t gid{};
};

/// The folder that one run writes its results into.
///
/// It did not exist before, and nothing in it is reached through a symbolic link: all work goes
/// through a descriptor of the folder itself, so that nobody can put another one in its place.
class RunDirectory {
 public:
  /// Makes `path` (mode 0755) and its logs/ folder; the parents are made when they are missing, and
  /// given to `parents_owner` when there is one.
  /// @throws std::system_error naming the folder, when it exists, as anything, or cannot be made.
  [[nodiscard]] static RunDirectory create(const std::filesystem::path& path,
                                           std::optional<Owner> parents_owner = std::nullopt);

  /// Absolute.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Writes a whole file `name`, such as "summary.json": whoever looks finds the old content, or
  /// the new, never a part, not even after a power cut (write, fsync, rename).
  /// @throws std::system_error; the file is then as it was before.
  void write_file(const std::string& name, std::string_view content) const;

  /// A new file `name` to append to, such as "metrics.csv".
  /// @throws std::system_error, also when it exists.
  [[nodiscard]] posix::UniqueFd create_file(const std::string& name) const;

  /// A new file in its logs/ folder, to append to, such as "netsim.log".
  [[nodiscard]] posix::UniqueFd create_log(const std::string& name) const;

  /// A new folder `name` in it.
  void create_folder(const std::string& name) const;

  /// Gives the folder and all in it away. What the system refuses to give stays ours.
  void give_to(Owner owner) const noexcept;

 private:
  RunDirectory(std::filesystem::path path, posix::UniqueFd fd)
      : path_{std::move(path)}, fd_{std::move(fd)} {}

  std::filesystem::path path_;
  posix::UniqueFd fd_;
};

/// Writes all of `content`, however many calls that takes.
/// @throws std::system_error
void write_all(int fd, std::string_view content);

// Names in a run directory; docs/results.md describes the content.
inline constexpr std::string_view kResolvedScenarioFile = "scenario.resolved.json";
inline constexpr std::string_view kFidelityFile = "fidelity.json";
inline constexpr std::string_view kSummaryFile = "summary.json";
inline constexpr std::string_view kMetricsFile = "metrics.csv";
inline constexpr std::string_view kLinksFile = "links.csv";
inline constexpr std::string_view kFrameLogFile = "frames.csv";
inline constexpr std::string_view kReceptionLogFile = "receptions.bin";
inline constexpr std::string_view kCaptureFolder = "captures";
inline constexpr std::string_view kLogFolder = "logs";

}  // namespace cuscus::orchestrator
