#include "orchestrator/app/ownership.h"

#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace cuscus::orchestrator {
namespace {

std::optional<std::uint32_t> number_in_environment(const char* name) {
  // Read while there is one thread.
  const char* const text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  if (text == nullptr) {
    return std::nullopt;
  }
  const std::string_view digits{text};
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc{} && end == digits.data() + digits.size() ? std::optional{number}
                                                                      : std::nullopt;
}

}  // namespace

std::optional<Owner> sudo_caller() {
  const auto uid = number_in_environment("SUDO_UID");
  const auto gid = number_in_environment("SUDO_GID");
  if (::geteuid() != 0 || !uid || !gid || *uid == 0) {
    return std::nullopt;
  }
  return Owner{.uid = *uid, .gid = *gid};
}

}  // namespace cuscus::orchestrator
