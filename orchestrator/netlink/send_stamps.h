#pragma once

#include <linux/bpf.h>

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/posix/unique_fd.h"
#include "orchestrator/netlink/route_socket.h"

namespace cuscus::netlink {

/// Why something that a run can do without is not to be had here.
struct NotAvailable {
  std::string reason;
};

/// The program that stamps what leaves one node's interface: it writes one cuscus::shm::SendStamp
/// into the ring behind `ring_fd` and lets the frame pass. Pure.
[[nodiscard]] std::vector<bpf_insn> send_stamp_program(std::uint32_t node, int ring_fd);

/// Send stamps of the whole fleet: a BPF ring buffer, in the global order of the sends, into which
/// one small program per node writes at the egress of its wlan0. A stamp is taken in the sender's
/// own system call, so that it says when a frame was sent, however late the emulator comes to read
/// it.
///
/// A full ring loses stamps, never frames. The reader is whoever maps the ring.
class SendStampRing {
 public:
  static constexpr std::uint32_t kDefaultBytes = 16U << 20U;  // 230 000 stamps

  /// Makes the ring and tries a program on the loopback of a scratch namespace, so that a later
  /// attach() has no reason to fail. NotAvailable where bpf() or the tc hook is not to be had, as
  /// in a user namespace: the caller goes on with read stamps, and says so.
  [[nodiscard]] static std::variant<SendStampRing, NotAvailable> create(
      std::uint32_t byte_size = kDefaultBytes);

  /// Stamps all frames that leave by a link as those of `node`, until the link goes. `where` is of
  /// the link's namespace.
  void attach(RouteSocket& where, std::uint32_t link_index, std::uint32_t node) const;

  /// Descriptors::KIND_SEND_STAMP_RING: the map, for mmap() in netsim.
  [[nodiscard]] int fd() const noexcept { return ring_.get(); }

 private:
  explicit SendStampRing(posix::UniqueFd ring) noexcept : ring_{std::move(ring)} {}

  posix::UniqueFd ring_;
};

}  // namespace cuscus::netlink
