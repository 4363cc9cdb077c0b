#include "orchestrator/app/ownership.h"

#include <unistd.h>

#include <cstdlib>
#include <system_error>

namespace cuscus::orchestrator {

void give_to_caller(const std::filesystem::path& folder) {
  // Read while there is one thread.
  const char* const uid = std::getenv("SUDO_UID");  // NOLINT(concurrency-mt-unsafe)
  const char* const gid = std::getenv("SUDO_GID");  // NOLINT(concurrency-mt-unsafe)
  if (uid == nullptr || gid == nullptr || ::geteuid() != 0) {
    return;
  }
  const auto user = static_cast<uid_t>(std::strtoul(uid, nullptr, 10));
  const auto group = static_cast<gid_t>(std::strtoul(gid, nullptr, 10));
  const auto give = [&](const std::filesystem::path& path) {
    // A file that stays root's can still be read; nothing is lost.
    static_cast<void>(::lchown(path.c_str(), user, group) == 0);
  };
  give(folder);
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder, error}) {
    give(entry.path());
  }
}

}  // namespace cuscus::orchestrator
