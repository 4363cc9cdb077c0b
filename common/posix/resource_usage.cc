#include "common/posix/resource_usage.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <ctime>
#include <string_view>

#include "common/posix/unique_fd.h"

namespace cuscus::posix {

double process_cpu_s() noexcept {
  timespec used{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

std::uint64_t resident_bytes() noexcept {
  // proc(5), /proc/pid/statm: size, resident, ... in pages.
  const UniqueFd statm{::open("/proc/self/statm", O_RDONLY | O_CLOEXEC)};
  std::array<char, 128> buffer{};
  const ssize_t length = statm ? ::read(statm.get(), buffer.data(), buffer.size()) : -1;
  if (length <= 0) {
    return 0;
  }
  const std::string_view text{buffer.data(), static_cast<std::size_t>(length)};
  const std::size_t blank = text.find(' ');
  std::uint64_t pages = 0;
  if (blank != std::string_view::npos) {
    std::from_chars(text.data() + blank + 1, text.data() + text.size(), pages);
  }
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace cuscus::posix
