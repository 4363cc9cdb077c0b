#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "common/posix/unique_fd.h"
#include "orchestrator/netlink/send_stamps.h"

namespace cuscus::orchestrator {

/// The processor on which a run keeps its emulator, while the kernel works on the others on what
/// the emulator has written. No two runs of a network namespace get the same; it is free again when
/// this object goes or its process dies.
class EmulatorProcessor {
 public:
  /// One that this process may use and that no run has, or why there is none.
  [[nodiscard]] static std::variant<EmulatorProcessor, netlink::NotAvailable> reserve();

  [[nodiscard]] int number() const noexcept { return number_; }
  /// What else this process may use; at least one.
  [[nodiscard]] std::span<const int> others() const noexcept { return others_; }
  /// Frames that found the queue of one of this machine's processors full since reserve(): what was
  /// written to a TAP and never arrived (net.core.netdev_max_backlog).
  [[nodiscard]] std::uint64_t backlog_drops() const;

 private:
  EmulatorProcessor(int number, std::vector<int> others, posix::UniqueFd reservation);

  int number_;
  std::vector<int> others_;
  posix::UniqueFd reservation_;
  std::uint64_t drops_before_;
};

}  // namespace cuscus::orchestrator
