#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/posix/unique_fd.h"
#include "netsim/app/ppdu_queue.h"
#include "netsim/capture/ppdu_encoder.h"

namespace cuscus::netsim {

/// What is captured, and into which files.
struct CaptureSetup {
  std::vector<posix::UniqueFd> files{};  ///< By node, open for writing; empty: none of that node.
  std::vector<std::string> names{};      ///< Of all nodes.
  std::uint32_t snap_length{};           ///< Of a packet with its radiotap header [B]; 0: all.
  bool failed{};                         ///< Also receptions that failed by their FCS.
};

/// Writes what nodes' radios send and receive into pcapng files with radiotap headers, from a
/// thread of its own: add() never waits for the disk. docs/captures.md describes the files.
class CaptureFiles {
 public:
  /// Writes the files' headers. @throws std::system_error
  CaptureFiles(CaptureSetup setup, PpduEncoder encoder);
  CaptureFiles(const CaptureFiles&) = delete;
  CaptureFiles& operator=(const CaptureFiles&) = delete;
  CaptureFiles(CaptureFiles&&) = delete;
  CaptureFiles& operator=(CaptureFiles&&) = delete;
  ~CaptureFiles();

  /// When SimTime 0 is [ns since 1970]; before anything is added.
  void start(std::int64_t realtime_ns) { start_realtime_ns_ = realtime_ns; }

  /// Whether a PPDU at that node belongs into a capture; `cause`: kNone for its own.
  [[nodiscard]] bool wants(std::uint32_t node, LossCause cause) const {
    return files_[node].fd && (cause == LossCause::kNone || (failed_ && fails_by_fcs(cause)));
  }

  // From one thread. What finds no room, or has no payload, is counted and left out.
  void add(const PpduRecord& record, std::span<const std::uint8_t> ethernet) noexcept;
  void leave_out(std::uint32_t node) noexcept { ++files_[node].left_out; }

  /// Writes what is left; nothing may be added any more.
  void finish();
  // After finish(), of all files.
  [[nodiscard]] std::uint64_t packets() const;
  [[nodiscard]] std::uint64_t packets_left_out() const;

 private:
  struct File {
    posix::UniqueFd fd;
    std::vector<std::uint8_t> pending;  ///< Whole blocks that are not written yet.
    std::uint64_t pending_packets{0};
    std::uint64_t written_bytes{0};
    std::uint64_t packets{0};
    std::uint64_t unwritten{0};  ///< Packets that the file did not take.
    std::uint64_t left_out{0};   ///< The adding thread's.
    std::uint64_t last_ns{0};
    bool broken{false};  ///< It took no more.
  };

  void write_out();
  void append(const PpduRecord& record, std::span<const std::uint8_t> ethernet);
  void serve(const std::stop_token& stop);
  static void write_pending(File& file);

  std::vector<File> files_;  ///< By node.
  std::vector<std::string> names_;
  std::uint32_t snap_length_;
  bool failed_;
  PpduEncoder encoder_;
  std::atomic<std::int64_t> start_realtime_ns_{0};
  PpduQueue queue_;
  std::vector<std::uint8_t> packet_;
  std::jthread writer_;
};

}  // namespace cuscus::netsim
