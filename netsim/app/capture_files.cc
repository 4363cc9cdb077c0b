#include "netsim/app/capture_files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include "common/posix/check.h"
#include "netsim/capture/pcapng.h"

namespace cuscus::netsim {
namespace {

/// A second of a stalled disk while 100 nodes hear 2 000 frames of 100 B per second.
constexpr std::size_t kQueueBytes = std::size_t{32} << 20U;
constexpr auto kWritePeriod = std::chrono::milliseconds{50};
constexpr std::size_t kWriteBytes = std::size_t{256} << 10U;

bool write_octets(int fd, std::span<const std::uint8_t> octets) {
  while (!octets.empty()) {
    const ::ssize_t written = ::write(fd, octets.data(), octets.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      return false;
    }
    octets = octets.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

CaptureFiles::CaptureFiles(CaptureSetup setup, PpduEncoder encoder)
    : names_{std::move(setup.names)},
      snap_length_{setup.snap_length},
      failed_{setup.failed},
      encoder_{std::move(encoder)},
      queue_{kQueueBytes} {
  for (posix::UniqueFd& fd : setup.files) {
    File& file = files_.emplace_back();
    file.fd = std::move(fd);
    if (!file.fd) {
      continue;
    }
    pcapng::append_section_header(file.pending, "cuscus-netsim");
    pcapng::append_interface(file.pending, {.name = names_[files_.size() - 1],
                                            .description = "emulated 802.11 radio",
                                            .snap_length = snap_length_});
    write_pending(file);
    if (file.broken) {
      posix::throw_errno("write a capture");
    }
  }
  writer_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
}

CaptureFiles::~CaptureFiles() { finish(); }

void CaptureFiles::add(const PpduRecord& record, std::span<const std::uint8_t> ethernet) noexcept {
  if (!queue_.add(record, ethernet)) {
    leave_out(record.node);
  }
}

void CaptureFiles::append(const PpduRecord& record, std::span<const std::uint8_t> ethernet) {
  File& file = files_[record.node];
  packet_.clear();
  encoder_.append(packet_, record, ethernet);
  std::span<const std::uint8_t> captured{packet_};
  if (snap_length_ > 0) {
    captured = captured.first(std::min<std::size_t>(captured.size(), snap_length_));
  }
  file.last_ns = static_cast<std::uint64_t>(start_realtime_ns_ + to_ns(record.time()));
  pcapng::append_packet(file.pending, {.time_ns = file.last_ns,
                                       .octets = captured,
                                       .original_bytes = static_cast<std::uint32_t>(packet_.size()),
                                       .outbound = record.own,
                                       .comment = comment_of(record, names_)});
  ++file.pending_packets;
  if (file.pending.size() >= kWriteBytes) {
    write_pending(file);
  }
}

/// A file that takes no more, on a full disk say, ends with its last whole block.
void CaptureFiles::write_pending(File& file) {
  if (!file.broken && !write_octets(file.fd.get(), file.pending)) {
    file.broken = true;
    const int reason = errno;
    static_cast<void>(::ftruncate(file.fd.get(), static_cast<::off_t>(file.written_bytes)) == 0);
    errno = reason;
  }
  if (file.broken) {
    file.unwritten += file.pending_packets;
  } else {
    file.written_bytes += file.pending.size();
    file.packets += file.pending_packets;
  }
  file.pending_packets = 0;
  file.pending.clear();
}

void CaptureFiles::write_out() {
  queue_.drain([this](const PpduRecord& record, std::span<const std::uint8_t> ethernet) {
    append(record, ethernet);
  });
  for (File& file : files_) {
    if (file.fd && !file.pending.empty()) {
      write_pending(file);
    }
  }
}

void CaptureFiles::serve(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    write_out();
    std::this_thread::sleep_for(kWritePeriod);
  }
  write_out();
}

void CaptureFiles::finish() {
  if (!writer_.joinable()) {
    return;
  }
  writer_.request_stop();
  writer_.join();
  for (File& file : files_) {
    if (file.fd) {
      pcapng::append_statistics(file.pending, {.time_ns = file.last_ns,
                                               .captured = file.packets,
                                               .dropped = file.left_out + file.unwritten});
      write_pending(file);
    }
  }
}

std::uint64_t CaptureFiles::packets() const {
  std::uint64_t sum = 0;
  for (const File& file : files_) {
    sum += file.packets;
  }
  return sum;
}

std::uint64_t CaptureFiles::packets_left_out() const {
  std::uint64_t sum = 0;
  for (const File& file : files_) {
    sum += file.left_out + file.unwritten;
  }
  return sum;
}

}  // namespace cuscus::netsim
