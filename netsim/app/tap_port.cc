#include "netsim/app/tap_port.h"

#include <unistd.h>

#include <cerrno>

namespace cuscus::netsim {

std::optional<std::span<const std::uint8_t>> TapPort::read(std::span<std::uint8_t> buffer) {
  for (;;) {
    const ::ssize_t bytes = ::read(fd_.get(), buffer.data(), buffer.size());
    if (bytes >= 0) {
      return buffer.first(static_cast<std::size_t>(bytes));
    }
    if (errno == EINTR) {
      continue;
    }
    if (errno != EAGAIN) {
      failed_ = errno;
    }
    return std::nullopt;
  }
}

bool TapPort::write(std::span<const std::uint8_t> frame) {
  for (;;) {
    const ::ssize_t bytes = ::write(fd_.get(), frame.data(), frame.size());
    if (bytes >= 0 || errno != EINTR) {
      return bytes == static_cast<::ssize_t>(frame.size());
    }
  }
}

}  // namespace cuscus::netsim
