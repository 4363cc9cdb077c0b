#include "orchestrator/netlink/send_stamps.h"

#include <linux/pkt_cls.h>

#include <cstddef>
#include <exception>

#include "common/posix/network_namespace.h"
#include "orchestrator/netlink/bpf_program.h"
#include "proto/shm/send_stamp.h"

namespace cuscus::netlink {
namespace {

using shm::SendStamp;

/// Where a member of the stamp lies, seen from the frame pointer: the stamp is the program's whole
/// stack frame.
constexpr std::int16_t at(std::size_t member_offset) {
  return static_cast<std::int16_t>(static_cast<int>(member_offset) -
                                   static_cast<int>(sizeof(SendStamp)));
}

constexpr std::int16_t kHead = at(offsetof(SendStamp, head));

}  // namespace

std::vector<bpf_insn> send_stamp_program(std::uint32_t node, int ring_fd) {
  using namespace bpf;  // NOLINT(google-build-using-namespace): reads as the assembler it is
  constexpr auto kFrameBytes = Register::kR7;
  constexpr auto kBuffer = Register::kR6;
  constexpr auto kHeadBytes = static_cast<std::int32_t>(SendStamp::kHeadBytes);
  std::vector<bpf_insn> program{
      move(kBuffer, Register::kR1),
      call(BPF_FUNC_ktime_get_ns),
      store(Width::kDoubleWord, Register::kFrame, at(offsetof(SendStamp, monotonic_ns)),
            Register::kR0),
      store(Width::kWord, Register::kFrame, at(offsetof(SendStamp, node)),
            static_cast<std::int32_t>(node)),
      load(Width::kWord, kFrameBytes, kBuffer, offsetof(__sk_buff, len)),
      store(Width::kWord, Register::kFrame, at(offsetof(SendStamp, frame_bytes)), kFrameBytes),
  };
  for (std::int16_t offset = 0; offset < kHeadBytes;
       offset = static_cast<std::int16_t>(offset + 8)) {
    program.push_back(
        store(Width::kDoubleWord, Register::kFrame, static_cast<std::int16_t>(kHead + offset), 0));
  }
  const std::vector<bpf_insn> rest{
      // r4 = min(len, 48); the two comparisons are also what the verifier needs to see that 1 to 48
      // bytes are read. A difference to zero would do on new kernels, but not on 6.1.
      move(Register::kR4, kFrameBytes),
      skip_if_at_most(1, Register::kR4, kHeadBytes),
      move(Register::kR4, kHeadBytes),
      skip_if_below(5, Register::kR4, 1),
      move(Register::kR1, kBuffer),
      move(Register::kR2, 0),
      move(Register::kR3, Register::kFrame),
      add(Register::kR3, kHead),
      call(BPF_FUNC_skb_load_bytes),
      // Flags 0: the reader is woken when it waits for the ring, and costs nothing when it does
      // not.
      load_map(Register::kR1, ring_fd),
      load_map_end(),
      move(Register::kR2, Register::kFrame),
      add(Register::kR2, at(0)),
      move(Register::kR3, static_cast<std::int32_t>(sizeof(SendStamp))),
      move(Register::kR4, 0),
      call(BPF_FUNC_ringbuf_output),
      move(Register::kR0, TC_ACT_UNSPEC),
      leave(),
  };
  program.insert(program.end(), rest.begin(), rest.end());
  return program;
}

std::variant<SendStampRing, NotAvailable> SendStampRing::create(std::uint32_t byte_size) {
  try {
    SendStampRing ring{bpf::create_ring_buffer(byte_size, "cuscus_stamps")};
    constexpr std::uint32_t kLoopbackIndex = 1;
    const auto scratch = posix::NetworkNamespace::create();
    auto routes = RouteSocket::in(scratch);
    ring.attach(routes, kLoopbackIndex, 0);
    return ring;
  } catch (const std::exception& error) {
    return NotAvailable{error.what()};
  }
}

void SendStampRing::attach(RouteSocket& where, std::uint32_t link_index, std::uint32_t node) const {
  const auto program = bpf::load_traffic_program(send_stamp_program(node, fd()), "send_stamp");
  where.add_clsact(link_index);
  where.add_egress_program(link_index, program.get(), "cuscus_stamp");
}

}  // namespace cuscus::netlink
