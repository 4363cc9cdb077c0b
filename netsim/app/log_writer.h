#pragma once

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/unique_fd.h"

namespace cuscus::netsim {

/// Writes records to a file from a thread of its own: add() never waits for the disk.
/// `Format` has `void operator()(std::string& text, const Record& record) const`, which appends.
template <typename Record, typename Format>
class LogWriter {
 public:
  /// Takes over a descriptor open for writing and writes the header. `capacity` records wait at
  /// most.
  LogWriter(posix::UniqueFd file, std::string_view header, std::size_t capacity)
      : file_{std::move(file)}, records_(capacity) {
    if (!write_all(header)) {
      posix::throw_errno("write the header of a log");
    }
    writer_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
  }
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  LogWriter(LogWriter&&) = delete;
  LogWriter& operator=(LogWriter&&) = delete;
  ~LogWriter() { finish(); }

  /// From one thread. A record that finds no room is counted and left out.
  void add(const Record& record) noexcept {
    const std::uint64_t added = added_.load(std::memory_order_relaxed);
    if (added - written_.load(std::memory_order_acquire) >= records_.size()) {
      left_out_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    records_[added % records_.size()] = record;
    added_.store(added + 1, std::memory_order_release);
  }

  /// Writes what is left; nothing may be added any more. How many records the file lacks.
  std::uint64_t finish() {
    if (writer_.joinable()) {
      writer_.request_stop();
      writer_.join();
    }
    return left_out_.load(std::memory_order_relaxed);
  }

 private:
  static constexpr std::chrono::milliseconds kPeriod{50};

  bool write_all(std::string_view text) {
    while (!text.empty()) {
      const ::ssize_t written = ::write(file_.get(), text.data(), text.size());
      if (written < 0 && errno == EINTR) {
        continue;
      }
      if (written < 0) {
        return false;
      }
      text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

  void write_out(std::string& text) {
    text.clear();
    const std::uint64_t added = added_.load(std::memory_order_acquire);
    const std::uint64_t first = written_.load(std::memory_order_relaxed);
    for (std::uint64_t next = first; next < added; ++next) {
      Format{}(text, records_[next % records_.size()]);
    }
    // After a failure, of a full disk say, nothing more is written: a record that was cut is the
    // last.
    broken_ = broken_ || !write_all(text);
    if (broken_) {
      left_out_.fetch_add(added - first, std::memory_order_relaxed);
    }
    written_.store(added, std::memory_order_release);
  }

  void serve(const std::stop_token& stop) {
    std::string text;
    while (!stop.stop_requested()) {
      write_out(text);
      std::this_thread::sleep_for(kPeriod);
    }
    write_out(text);
  }

  posix::UniqueFd file_;
  std::vector<Record> records_;  ///< A ring; indices count on.
  std::atomic<std::uint64_t> added_{0};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> left_out_{0};
  bool broken_{false};  ///< The file took no more; the writer's.
  std::jthread writer_;
};

}  // namespace cuscus::netsim
