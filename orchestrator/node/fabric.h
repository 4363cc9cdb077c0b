#pragma once

#include "common/posix/network_namespace.h"

namespace cuscus::node {

/// The network namespace of one run that holds what connects its nodes to netsim: bridges, the
/// outer ends of veth pairs, TAPs. It has no name, no address and no process; it goes with its last
/// descriptor.
class Fabric {
 public:
  /// @throws std::system_error without CAP_SYS_ADMIN.
  [[nodiscard]] static Fabric create();

  [[nodiscard]] const posix::NetworkNamespace& network_namespace() const noexcept {
    return namespace_;
  }

 private:
  explicit Fabric(posix::NetworkNamespace where) noexcept : namespace_{std::move(where)} {}

  posix::NetworkNamespace namespace_;
};

}  // namespace cuscus::node
