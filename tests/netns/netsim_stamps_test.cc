// The ring of send stamps with a real kernel: a program at the egress of each node's interface.
#include <linux/bpf.h>
#include <sys/syscall.h>

#include <catch2/catch.hpp>
#include <string>

#include "tests/netns/tap_node.h"

namespace cuscus::netsim {
namespace {

using posix::UniqueFd;

// linux/bpf.h of Linux 6.6 (attach types are ABI); Debian 12's header is older.
constexpr std::uint32_t kTcxEgress = 47;
constexpr std::int32_t kNextProgram = -1;
constexpr std::uint32_t kRingBytes = 1U << 22U;  ///< 58 000 stamps.

int bpf(int command, bpf_attr& attributes) {
  return static_cast<int>(::syscall(SYS_bpf, command, &attributes, sizeof attributes));
}

/// A program that writes a proto/shm/send_stamp.h record for every frame; assembled by hand.
UniqueFd load_program(int ring, std::uint32_t node) {
  std::vector<bpf_insn> code;
  const auto add = [&](int opcode, std::uint8_t to, std::uint8_t from, int offset,
                       std::int32_t value) {
    bpf_insn instruction{};
    instruction.code = static_cast<std::uint8_t>(opcode);
    instruction.dst_reg = to & 0xfU;
    instruction.src_reg = from & 0xfU;
    instruction.off = static_cast<std::int16_t>(offset);
    instruction.imm = value;
    code.push_back(instruction);
  };
  const auto call = [&](std::int32_t helper) { add(BPF_JMP | BPF_CALL, 0, 0, 0, helper); };
  const auto move = [&](std::uint8_t to, std::uint8_t from) {
    add(BPF_ALU64 | BPF_MOV | BPF_X, to, from, 0, 0);
  };
  const auto set = [&](std::uint8_t to, std::int32_t value) {
    add(BPF_ALU64 | BPF_MOV | BPF_K, to, 0, 0, value);
  };
  // The stamp lies at frame pointer (r10) - 64: time, node, length, head. r6 is the socket buffer.
  move(6, 1);
  call(BPF_FUNC_ktime_get_ns);
  add(BPF_STX | BPF_MEM | BPF_DW, 10, 0, -64, 0);
  add(BPF_ST | BPF_MEM | BPF_W, 10, 0, -56, static_cast<std::int32_t>(node));
  add(BPF_LDX | BPF_MEM | BPF_W, 4, 6, 0, 0);  // skb->len
  add(BPF_STX | BPF_MEM | BPF_W, 10, 4, -52, 0);
  for (int offset = -48; offset < 0; offset += 8) {
    add(BPF_ST | BPF_MEM | BPF_DW, 10, 0, offset, 0);
  }
  add(BPF_JMP | BPF_JLE | BPF_K, 4, 0, 1, 48);
  set(4, 48);
  add(BPF_JMP | BPF_JGE | BPF_K, 4, 0, 2, 1);
  set(0, kNextProgram);
  add(BPF_JMP | BPF_EXIT, 0, 0, 0, 0);
  move(1, 6);
  set(2, 0);
  move(3, 10);
  add(BPF_ALU64 | BPF_ADD | BPF_K, 3, 0, 0, -48);
  call(BPF_FUNC_skb_load_bytes);
  add(BPF_LD | BPF_DW | BPF_IMM, 1, BPF_PSEUDO_MAP_FD, 0, ring);
  add(0, 0, 0, 0, 0);
  move(2, 10);
  add(BPF_ALU64 | BPF_ADD | BPF_K, 2, 0, 0, -64);
  set(3, sizeof(shm::SendStamp));
  set(4, 0);
  call(BPF_FUNC_ringbuf_output);
  set(0, kNextProgram);
  add(BPF_JMP | BPF_EXIT, 0, 0, 0, 0);

  std::string complaints(1U << 16U, '\0');
  bpf_attr load{};
  load.prog_type = BPF_PROG_TYPE_SCHED_CLS;
  load.insns = reinterpret_cast<std::uint64_t>(code.data());
  load.insn_cnt = static_cast<std::uint32_t>(code.size());
  load.license = reinterpret_cast<std::uint64_t>("GPL");
  load.log_buf = reinterpret_cast<std::uint64_t>(complaints.data());
  load.log_size = static_cast<std::uint32_t>(complaints.size());
  load.log_level = 1;
  const int fd = bpf(BPF_PROG_LOAD, load);
  INFO(complaints.c_str());
  REQUIRE(fd >= 0);
  return UniqueFd{fd};
}

/// Programs stay attached while their links live.
struct Stamping {
  std::vector<UniqueFd> links;
  std::string missing;  ///< Why there are no stamps, when there are none.

  std::unique_ptr<StampRing> attach(std::vector<TapNode>& nodes) {
    bpf_attr map{};
    map.map_type = BPF_MAP_TYPE_RINGBUF;
    map.max_entries = kRingBytes;
    UniqueFd ring{bpf(BPF_MAP_CREATE, map)};
    if (ring.get() < 0) {
      missing = "no right to bpf()";
      return nullptr;
    }
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
      const UniqueFd program = load_program(ring.get(), node);
      nodes[node].space.run([&] {
        bpf_attr link{};
        link.link_create.prog_fd = static_cast<std::uint32_t>(program.get());
        link.link_create.target_ifindex = ::if_nametoindex("wlan0");
        link.link_create.attach_type = kTcxEgress;
        links.emplace_back(bpf(BPF_LINK_CREATE, link));
      });
      if (links.back().get() < 0) {
        missing = "no TCX: Linux before 6.6";
        return nullptr;
      }
    }
    return std::make_unique<StampRing>(std::move(ring));
  }
};

TEST_CASE("with send stamps frames enter at their send time and arrive whole") {
  Stamping stamping;
  TapFleet fleet{3, [&](std::vector<TapNode>& nodes) { return stamping.attach(nodes); }};
  if (!stamping.missing.empty()) {
    WARN("skipped: " << stamping.missing);
    return;
  }
  constexpr int kDatagrams = 60;

  for (int i = 0; i < kDatagrams; ++i) {
    const auto from = static_cast<std::uint32_t>(i % 3);
    const std::string text(static_cast<std::size_t>(1 + 13 * i), static_cast<char>('a' + i % 26));
    fleet.send(from, test_address(255), text);
    for (std::uint32_t node = 0; node < 3; ++node) {
      REQUIRE(fleet.receive(node) == text);
    }
  }
  fleet.send(0, test_address(2), "to one");  // with ARP, both ways
  REQUIRE(fleet.receive(1) == "to one");
  fleet.stop();

  const auto report = fleet.air().report();
  CHECK(report.send_stamps() == "tc-bpf");
  CHECK(report.unstamped() == 0);
  CHECK(report.lost_before_air() == 0);
  CHECK(report.ingress_delay().count() == kDatagrams + 3);
  std::uint64_t received = 0;
  for (std::uint32_t node = 0; node < 3; ++node) {
    received += fleet.air().tally(node).received;
    CHECK(fleet.air().tally(node).lost_interface == 0);
  }
  // The ARP request reaches two, its answer and the datagram one each.
  CHECK(received == 2 * kDatagrams + 4);
}

TEST_CASE("a flood fills the sender's own queue, and another node's frames still pass") {
  Stamping stamping;
  TapFleet fleet{3, [&](std::vector<TapNode>& nodes) { return stamping.attach(nodes); }};
  if (!stamping.missing.empty()) {
    WARN("skipped: " << stamping.missing);
    return;
  }
  // 5000 frames of 1 ms each at 6 Mb/s, at once: the queue holds 500.
  const std::string flood(700, 'f');
  for (int i = 0; i < 5'000; ++i) {
    fleet.send(0, test_address(255), flood);
  }
  fleet.send(1, test_address(255), "still here");

  std::string text = flood;
  while (text == flood) {
    text = fleet.receive(2);
  }
  CHECK(text == "still here");
  fleet.stop();

  const auto tally = fleet.air().tally(0);
  CHECK(tally.dropped_queue_full > 3'000);
  CHECK(tally.offered == 5'000);
  CHECK(fleet.air().report().unstamped() == 0);
  CHECK(fleet.air().tally(1).dropped_queue_full == 0);
}

TEST_CASE("what a node sends beyond its queue while nobody looks is dropped there and counted") {
  Stamping stamping;
  TapFleet fleet{3, [&](std::vector<TapNode>& nodes) { return stamping.attach(nodes); }};
  if (!stamping.missing.empty()) {
    WARN("skipped: " << stamping.missing);
    return;
  }
  // 1 ms each at 6 Mb/s; the queue holds 500, and the air 1000 more that wait for their time.
  constexpr int kFrames = 3'000;

  fleet.stall(100'000'000, [&] {
    for (int i = 0; i < kFrames; ++i) {
      fleet.send(0, test_address(255), std::string(700, 'f'));
    }
  });
  fleet.send(1, test_address(255), "still here");
  std::string text(700, 'f');
  while (text == std::string(700, 'f')) {
    text = fleet.receive(2);
  }
  CHECK(text == "still here");
  fleet.stop();

  const auto tally = fleet.air().tally(0);
  CHECK(tally.offered == kFrames);
  CHECK(tally.dropped_queue_full > 2'000);
  CHECK(tally.dropped_queue_full + tally.transmissions <= kFrames);
  CHECK(fleet.air().report().unstamped() == 0);
}

TEST_CASE("frames that were not read during a stall are not taken for lost") {
  Stamping stamping;
  TapFleet fleet{2, [&](std::vector<TapNode>& nodes) { return stamping.attach(nodes); }};
  if (!stamping.missing.empty()) {
    WARN("skipped: " << stamping.missing);
    return;
  }
  constexpr int kFrames = 400;  // more than are read at once, fewer than the TAP or the MAC holds

  fleet.stall(300'000'000, [&] {
    for (int i = 0; i < kFrames; ++i) {
      fleet.send(0, test_address(255), "while nobody reads");
    }
  });
  fleet.send(0, test_address(255), "last");
  std::string text = "while nobody reads";
  while (text == "while nobody reads") {
    text = fleet.receive(1);
  }
  CHECK(text == "last");
  fleet.stop();

  CHECK(fleet.air().report().lost_before_air() == 0);
  CHECK(fleet.air().report().unstamped() == 0);
  CHECK(fleet.air().tally(0).offered == kFrames + 1);
}

TEST_CASE("a copy that is over a second late is dropped and counted, and those after it come") {
  Stamping stamping;
  TapFleet fleet{2, [&](std::vector<TapNode>& nodes) { return stamping.attach(nodes); }};
  if (!stamping.missing.empty()) {
    WARN("skipped: " << stamping.missing);
    return;
  }

  fleet.stall(1'100'000'000, [&] { fleet.send(0, test_address(255), "too late"); });
  fleet.send(0, test_address(255), "in time");

  CHECK(fleet.receive(1) == "in time");
  fleet.stop();
  CHECK(fleet.air().tally(1).lost_interface == 1);
  CHECK(fleet.air().tally(1).received == 1);
  CHECK(fleet.air().report().release_lateness().max_ns() > 1'000'000'000);
}

}  // namespace
}  // namespace cuscus::netsim
