#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "common/posix/unique_fd.h"
#include "netsim/app/frame_record.h"

namespace cuscus::netsim {

/// Writes frame records to a file from a thread of its own: add() never waits for the disk.
class FrameLog {
 public:
  /// Takes over a descriptor open for writing and writes the header.
  FrameLog(posix::UniqueFd file, const AirParameters& parameters);
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;
  FrameLog(FrameLog&&) = delete;
  FrameLog& operator=(FrameLog&&) = delete;
  ~FrameLog();

  /// From one thread. A record that finds no room is counted and left out.
  void add(const FrameRecord& record) noexcept;

  /// Writes what is left; nothing may be added any more. How many records the file lacks.
  std::uint64_t finish();

 private:
  void write_out(std::string& text);
  void serve(const std::stop_token& stop);

  posix::UniqueFd file_;
  std::vector<FrameRecord> records_;  ///< A ring; indices count on.
  std::atomic<std::uint64_t> added_{0};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> left_out_{0};
  bool broken_{false};  ///< The file took no more; the writer's.
  std::jthread writer_;
};

}  // namespace cuscus::netsim
