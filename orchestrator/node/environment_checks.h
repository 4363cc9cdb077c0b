#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cuscus::node {

/// What `cuscus doctor` says about one thing that a run needs or can use.
struct EnvironmentCheck {
  enum class Result {
    kOk,
    kWarning,  ///< A run works, with less.
    kFail,     ///< A run cannot start.
  };

  std::string name;
  Result result{Result::kOk};
  std::string text;    ///< What was found.
  std::string remedy;  ///< What to do about it; empty when all is well.
};

/// Looks at everything that a run of `nodes` nodes needs, trying it in scratch namespaces. Changes
/// nothing outside the calling process, which it may move into a user namespace (acquire_rights()).
[[nodiscard]] std::vector<EnvironmentCheck> check_environment(std::size_t nodes);

/// A kernel's major and minor number, of uname -r such as "6.1.0-18-amd64"; zeros when it has none.
struct KernelVersion {
  unsigned major{};
  unsigned minor{};
  friend bool operator==(const KernelVersion&, const KernelVersion&) = default;
  friend constexpr bool operator<(const KernelVersion& a, const KernelVersion& b) noexcept {
    return a.major != b.major ? a.major < b.major : a.minor < b.minor;
  }
};
[[nodiscard]] KernelVersion parse_kernel_version(std::string_view release);

}  // namespace cuscus::node
