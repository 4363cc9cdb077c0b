#include "netsim/app/frame_log.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <string_view>

#include "common/posix/check.h"

namespace cuscus::netsim {
namespace {

/// At 20 000 frames per second, three seconds of a stalled disk.
constexpr std::size_t kCapacity = std::size_t{1} << 16U;
constexpr auto kPeriod = std::chrono::milliseconds{50};

bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ::ssize_t written = ::write(fd, text.data(), text.size());
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

}  // namespace

FrameLog::FrameLog(posix::UniqueFd file, const AirParameters& parameters)
    : file_{std::move(file)}, records_(kCapacity) {
  if (!write_all(file_.get(), frame_log_header(parameters))) {
    posix::throw_errno("write the frame log");
  }
  writer_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
}

FrameLog::~FrameLog() { finish(); }

std::uint64_t FrameLog::finish() {
  if (writer_.joinable()) {
    writer_.request_stop();
    writer_.join();
  }
  return left_out_.load(std::memory_order_relaxed);
}

void FrameLog::add(const FrameRecord& record) noexcept {
  const std::uint64_t added = added_.load(std::memory_order_relaxed);
  if (added - written_.load(std::memory_order_acquire) >= kCapacity) {
    left_out_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  records_[added % kCapacity] = record;
  added_.store(added + 1, std::memory_order_release);
}

void FrameLog::write_out(std::string& text) {
  text.clear();
  const std::uint64_t added = added_.load(std::memory_order_acquire);
  std::uint64_t next = written_.load(std::memory_order_relaxed);
  const std::uint64_t first = next;
  for (; next < added; ++next) {
    append_frame_record(text, records_[next % kCapacity]);
  }
  // After a failure, of a full disk say, nothing more is written: a line that was cut is the last.
  broken_ = broken_ || !write_all(file_.get(), text);
  if (broken_) {
    left_out_.fetch_add(added - first, std::memory_order_relaxed);
  }
  written_.store(added, std::memory_order_release);
}

void FrameLog::serve(const std::stop_token& stop) {
  std::string text;
  while (!stop.stop_requested()) {
    write_out(text);
    std::this_thread::sleep_for(kPeriod);
  }
  write_out(text);
}

}  // namespace cuscus::netsim
