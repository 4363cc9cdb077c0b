#include "common/posix/kernel_settings.h"

#include <fcntl.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>

#include "common/posix/check.h"
#include "common/posix/unique_fd.h"

namespace cuscus::posix {
namespace {

/// Opens `path` for writing in a procfs or sysfs that is mounted nowhere, so that nobody has made
/// the mount read-only. Empty, with errno, when it cannot be had.
UniqueFd open_in_own(const char* file_system, const std::string& path) {
  const UniqueFd context{::fsopen(file_system, FSOPEN_CLOEXEC)};
  if (!context || ::fsconfig(context.get(), FSCONFIG_CMD_CREATE, nullptr, nullptr, 0) != 0) {
    return {};
  }
  const UniqueFd root{::fsmount(context.get(), FSMOUNT_CLOEXEC, 0)};
  if (!root) {
    return {};
  }
  UniqueFd file{::openat(root.get(), path.c_str(), O_WRONLY | O_CLOEXEC)};
  if (!file && errno == EROFS) {
    // Who mounted it first did so read-only, and all mounts of it share that; theirs stays so.
    if (::fsconfig(context.get(), FSCONFIG_SET_FLAG, "rw", nullptr, 0) == 0 &&
        ::fsconfig(context.get(), FSCONFIG_CMD_RECONFIGURE, nullptr, nullptr, 0) == 0) {
      file = UniqueFd{::openat(root.get(), path.c_str(), O_WRONLY | O_CLOEXEC)};
    }
  }
  return file;
}

}  // namespace

bool write_sysctl(const std::string& path, std::string_view value) {
  const std::string file = "/proc/sys/" + path;
  const std::string attempt = "write '" + std::string{value} + "' to " + file;
  UniqueFd fd{::open(file.c_str(), O_WRONLY | O_CLOEXEC)};
  if (!fd && errno == EROFS) {  // as in most containers
    fd = open_in_own("proc", "sys/" + path);
  }
  if (!fd && errno == ENOENT) {
    return false;
  }
  check(attempt, fd.get());
  check(attempt, ::write(fd.get(), value.data(), value.size()));
  return true;
}

void write_sysfs(const std::string& path, std::string_view value) {
  const std::string attempt = "write '" + std::string{value} + "' to /sys/" + path;
  // What is mounted at /sys shows the network namespace of whoever mounted it.
  const UniqueFd fd = open_in_own("sysfs", path);
  check(attempt, fd.get());
  check(attempt, ::write(fd.get(), value.data(), value.size()));
}

}  // namespace cuscus::posix
