#include <algorithm>
#include <charconv>

#include "orchestrator/node/environment_checks.h"

namespace cuscus::node {
namespace {

/// Cuts the next word off `line`.
std::string_view next_word(std::string_view& line) {
  const auto end = std::min(line.find(' '), line.size());
  const auto word = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  return word;
}

}  // namespace

CgroupLayout cgroup_layout(std::string_view mounts) {
  bool version_1 = false;
  bool version_2 = false;
  while (!mounts.empty()) {
    const auto end = std::min(mounts.find('\n'), mounts.size());
    auto line = mounts.substr(0, end);
    mounts.remove_prefix(std::min(end + 1, mounts.size()));
    static_cast<void>(next_word(line));  // the device
    static_cast<void>(next_word(line));  // the mount point
    const auto type = next_word(line);
    version_1 = version_1 || type == "cgroup";
    version_2 = version_2 || type == "cgroup2";
  }
  if (version_1) {
    return version_2 ? CgroupLayout::kHybrid : CgroupLayout::kVersion1;
  }
  return version_2 ? CgroupLayout::kVersion2 : CgroupLayout::kNone;
}

KernelVersion parse_kernel_version(std::string_view release) {
  KernelVersion version;
  const char* const end = release.data() + release.size();
  const auto major = std::from_chars(release.data(), end, version.major);
  if (major.ec == std::errc{} && major.ptr != end && *major.ptr == '.') {
    std::from_chars(major.ptr + 1, end, version.minor);
  }
  return version;
}

}  // namespace cuscus::node
