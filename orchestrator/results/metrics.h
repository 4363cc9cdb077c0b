#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/posix/unique_fd.h"
#include "common/units/sim_time.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::orchestrator {

/// One row of metrics.csv: one node at one instant. What is unknown becomes an empty field.
struct MetricsRow {
  SimTime time;
  std::string node;
  std::optional<shm::NodeState> motion;
  std::optional<double> formation_error_m;
  std::string flight_state;  ///< "flying"; empty where there is no autopilot.
  std::optional<shm::RadioTally> radio;
};

/// The header line of metrics.csv, units in the names, with its '\n'.
[[nodiscard]] std::string metrics_header();

/// `row` as a line with its '\n' (RFC 4180, fields quoted where they must be).
[[nodiscard]] std::string metrics_line(const MetricsRow& row);

/// Appends rows to a file. A full disk ends the file, not the run.
class MetricsWriter {
 public:
  /// Takes over `file`, which is empty.
  explicit MetricsWriter(posix::UniqueFd file);

  /// Keeps `row` until the next flush; writes by itself when much has come together.
  void add(const MetricsRow& row);

  /// Writes what was added.
  void flush();

  /// The first error, told once; rows after it are dropped.
  [[nodiscard]] std::optional<std::string> take_error();

  [[nodiscard]] std::uint64_t rows_dropped() const noexcept { return rows_dropped_; }

 private:
  posix::UniqueFd file_;
  std::string pending_;
  std::int64_t bytes_written_{0};  ///< Whole rows in the file.
  std::uint64_t rows_pending_{0};
  std::uint64_t rows_dropped_{0};
  bool failed_{false};
  std::optional<std::string> error_;
};

}  // namespace cuscus::orchestrator
