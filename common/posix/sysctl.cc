#include "common/posix/sysctl.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "common/posix/check.h"
#include "common/posix/unique_fd.h"

namespace cuscus::posix {

bool write_sysctl(const std::string& path, std::string_view value) {
  const std::string file = "/proc/sys/" + path;
  const std::string attempt = "write '" + std::string{value} + "' to " + file;
  const UniqueFd fd{::open(file.c_str(), O_WRONLY | O_CLOEXEC)};
  if (!fd && errno == ENOENT) {
    return false;
  }
  check(attempt, fd.get());
  check(attempt, ::write(fd.get(), value.data(), value.size()));
  return true;
}

}  // namespace cuscus::posix
