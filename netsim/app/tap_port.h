#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "common/posix/unique_fd.h"

namespace cuscus::netsim {

/// One node's TAP: a non-blocking descriptor (IFF_TAP | IFF_NO_PI) that gives and takes Ethernet
/// frames. A TAP that fails is no error of the run: its node falls silent.
class TapPort {
 public:
  /// Room for the largest frame that a TAP of any common MTU gives.
  static constexpr std::size_t kBufferBytes = 65'536;

  explicit TapPort(posix::UniqueFd fd) : fd_{std::move(fd)} {}

  /// The next frame, in `buffer`; nothing when there is none or the TAP failed().
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> read(std::span<std::uint8_t> buffer);
  /// False when the interface did not take the frame (down, full, gone).
  [[nodiscard]] bool write(std::span<const std::uint8_t> frame);

  /// The errno of a read that will not get better; 0 while all is well.
  [[nodiscard]] int failed() const { return failed_; }
  [[nodiscard]] int fd() const { return fd_.get(); }

 private:
  posix::UniqueFd fd_;
  int failed_{0};
};

}  // namespace cuscus::netsim
