#include "common/posix/open_file_limit.h"

#include <sys/resource.h>

#include <algorithm>

#include "common/posix/check.h"

namespace cuscus::posix {
namespace {

rlimit current() {
  rlimit limit{};
  check("getrlimit(RLIMIT_NOFILE)", ::getrlimit(RLIMIT_NOFILE, &limit));
  return limit;
}

}  // namespace

std::uint64_t raise_open_file_limit(std::uint64_t needed) {
  const rlimit limit = current();
  if (limit.rlim_cur >= needed) {
    return limit.rlim_cur;
  }
  rlimit wanted{.rlim_cur = needed, .rlim_max = std::max<rlim_t>(needed, limit.rlim_max)};
  if (::setrlimit(RLIMIT_NOFILE, &wanted) != 0) {
    wanted = {.rlim_cur = std::min<rlim_t>(needed, limit.rlim_max), .rlim_max = limit.rlim_max};
    check("setrlimit(RLIMIT_NOFILE)", ::setrlimit(RLIMIT_NOFILE, &wanted));
  }
  return current().rlim_cur;
}

std::uint64_t hard_open_file_limit() { return current().rlim_max; }

}  // namespace cuscus::posix
