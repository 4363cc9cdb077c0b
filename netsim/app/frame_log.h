#pragma once

#include <cstdint>
#include <string>

#include "common/posix/unique_fd.h"
#include "netsim/app/frame_record.h"
#include "netsim/app/log_writer.h"

namespace cuscus::netsim {

/// Writes frame records to a file from a thread of its own: add() never waits for the disk.
class FrameLog {
 public:
  /// Takes over a descriptor open for writing and writes the header.
  FrameLog(posix::UniqueFd file, const AirParameters& parameters);

  /// From one thread. A record that finds no room is counted and left out.
  void add(const FrameRecord& record) noexcept { writer_.add(record); }

  /// Writes what is left; nothing may be added any more. How many records the file lacks.
  std::uint64_t finish() { return writer_.finish(); }

 private:
  struct Format {
    void operator()(std::string& text, const FrameRecord& record) const {
      append_frame_record(text, record);
    }
  };

  LogWriter<FrameRecord, Format> writer_;
};

}  // namespace cuscus::netsim
