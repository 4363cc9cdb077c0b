#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "common/posix/network_namespace.h"
#include "common/posix/unique_fd.h"

namespace cuscus::test {

/// Sees network namespaces end without keeping them alive. It gives each a number in a namespace of
/// its own; the kernel tells when it takes such a number back (RTM_DELNSID), which it does once the
/// last process, descriptor and socket of that namespace are gone.
class NamespaceWatch {
 public:
  NamespaceWatch();

  /// Starts to watch the namespace behind an nsfs descriptor, which may be closed afterwards.
  void add(int namespace_fd);

  /// Namespaces that still live; waits until there are none, or for `limit`.
  [[nodiscard]] std::size_t await_end(std::chrono::milliseconds limit);

 private:
  posix::NetworkNamespace home_;
  posix::UniqueFd socket_;
  std::uint32_t sequence_{0};
  std::size_t living_{0};
};

}  // namespace cuscus::test
