#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "netsim/app/frame_record.h"

namespace cuscus::netsim {

/// A node's position from an instant on.
struct PositionRecord {
  std::int64_t time_ns;
  std::uint32_t node;
  Eigen::Vector3d p_WN;
};

/// A live run as its frame log tells it.
struct ReplayLog {
  AirParameters air;                      ///< What the log's header says; the rest is default.
  std::vector<FrameRecord> frames;        ///< By send time.
  std::vector<PositionRecord> positions;  ///< By time; empty: all in range.
};

/// A last line without its newline was cut, by a full disk say, and is left out.
/// @throws std::runtime_error naming file and line. `positions_path` may be empty.
[[nodiscard]] ReplayLog read_replay_log(const std::string& path, const std::string& positions_path);

/// Frames of one kind, in the live run or in its simulation.
struct ReplaySum {
  std::uint64_t frames{};
  std::uint64_t attempts{};
  std::uint64_t deliveries{};
  std::uint64_t frames_delivered{};  ///< To at least one node.
  double delay_sum_us{};             ///< Send to first delivery.
};

struct ReplayResult {
  struct Cast {
    ReplaySum live;
    ReplaySum simulated;
  };
  Cast group;
  Cast individual;
  std::vector<Tally> tallies;
};

/// Simulates the log's sends on the air of its header; without positions every link has
/// `equal_power`. With the positions of the run and its seed, backoffs and errors are drawn as they
/// were in the run. `receptions`, if any, gets a CSV table of what the simulation delivers: the
/// frame's line in the log, counted by send time from 0, its sender and send time, the receiver,
/// the time of delivery.
[[nodiscard]] ReplayResult replay(const ReplayLog& log, DecibelMilliwatt equal_power,
                                  std::ostream* receptions = nullptr);

/// A CSV table: one line per cast and side.
void print_replay(std::ostream& out, const ReplayLog& log, const ReplayResult& result);

}  // namespace cuscus::netsim
