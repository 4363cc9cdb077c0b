#include "common/posix/sysctl.h"

#include <fcntl.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>

#include "common/posix/check.h"
#include "common/posix/unique_fd.h"

namespace cuscus::posix {
namespace {

/// Opens /proc/sys/`path` in a procfs that is mounted nowhere, so that nobody has made it
/// read-only. Empty, with errno, when it cannot be had.
UniqueFd open_in_own_procfs(const std::string& path) {
  const UniqueFd context{::fsopen("proc", FSOPEN_CLOEXEC)};
  if (!context || ::fsconfig(context.get(), FSCONFIG_CMD_CREATE, nullptr, nullptr, 0) != 0) {
    return {};
  }
  const UniqueFd root{::fsmount(context.get(), FSMOUNT_CLOEXEC, 0)};
  return UniqueFd{root ? ::openat(root.get(), ("sys/" + path).c_str(), O_WRONLY | O_CLOEXEC) : -1};
}

}  // namespace

bool write_sysctl(const std::string& path, std::string_view value) {
  const std::string file = "/proc/sys/" + path;
  const std::string attempt = "write '" + std::string{value} + "' to " + file;
  UniqueFd fd{::open(file.c_str(), O_WRONLY | O_CLOEXEC)};
  if (!fd && errno == EROFS) {  // as in most containers
    fd = open_in_own_procfs(path);
  }
  if (!fd && errno == ENOENT) {
    return false;
  }
  check(attempt, fd.get());
  check(attempt, ::write(fd.get(), value.data(), value.size()));
  return true;
}

}  // namespace cuscus::posix
