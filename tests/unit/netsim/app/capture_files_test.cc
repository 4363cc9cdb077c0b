#include "netsim/app/capture_files.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "common/posix/check.h"
#include "netsim/app/ppdu_recorder.h"

namespace cuscus::netsim {
namespace {

using Octets = std::vector<std::uint8_t>;

constexpr std::uint32_t kEnhancedPacket = 6;
constexpr std::uint32_t kStatistics = 5;

/// A file that is gone with its scope.
class CaptureFile {
 public:
  CaptureFile() : fd{posix::check("mkostemp", ::mkostemp(path.data(), O_CLOEXEC))} {}
  CaptureFile(const CaptureFile&) = delete;
  CaptureFile& operator=(const CaptureFile&) = delete;
  CaptureFile(CaptureFile&&) = delete;
  CaptureFile& operator=(CaptureFile&&) = delete;
  ~CaptureFile() { ::unlink(path.c_str()); }

  [[nodiscard]] Octets octets() const {
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
  }

  std::string path{"/tmp/cuscus-capture-XXXXXX"};
  posix::UniqueFd fd;
};

std::uint32_t u32(const Octets& octets, std::size_t at) {
  return octets[at] | static_cast<std::uint32_t>(octets[at + 1]) << 8U |
         static_cast<std::uint32_t>(octets[at + 2]) << 16U |
         static_cast<std::uint32_t>(octets[at + 3]) << 24U;
}

/// A file's blocks by type, each whole; fails on one that is not.
std::vector<Octets> blocks_of(const Octets& octets, std::uint32_t type) {
  std::vector<Octets> found;
  for (std::size_t at = 0; at < octets.size();) {
    REQUIRE(octets.size() - at >= 12);
    const std::size_t length = u32(octets, at + 4);
    REQUIRE(length <= octets.size() - at);
    REQUIRE(u32(octets, at + length - 4) == length);
    if (u32(octets, at) == type) {
      found.emplace_back(octets.begin() + static_cast<std::ptrdiff_t>(at),
                         octets.begin() + static_cast<std::ptrdiff_t>(at + length));
    }
    at += length;
  }
  return found;
}

PpduEncoder encoder_of_two() {
  AirParameters air;
  air.nodes.assign(2, AirNode{});
  return {air, {0x020000000001, 0x020000000002}};
}

CaptureSetup of_node_1(CaptureFile& file) {
  CaptureSetup setup{.names = {"uav0", "uav1"}};
  setup.files.resize(2);
  setup.files[1] = std::move(file.fd);
  return setup;
}

/// Node 1 has received a frame of node 0.
PpduRecord received(SimTime time) {
  PpduRecord record{.node = 1};
  record.ppdu = {.frame = {.sender = 0}, .mode = &ieee80211g().mode(6'000)};
  record.reception = {.receiver = 1, .time = time, .power = {-50.0}};
  return record;
}

const Octets kEthernet{0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2, 0, 0, 0, 0, 1, 8, 0, 'h', 'i'};

TEST_CASE("a capture has its packets in order, at the run's wall clock") {
  CaptureFile file;
  CaptureFiles captures{of_node_1(file), encoder_of_two()};
  captures.start(1'000'000'000);

  captures.add(received(SimTime{} + Duration{7}), kEthernet);
  captures.add(received(SimTime{} + Duration{9}), kEthernet);
  captures.finish();

  const auto packets = blocks_of(file.octets(), kEnhancedPacket);
  REQUIRE(packets.size() == 2);
  CHECK(u32(packets[0], 16) == 1'000'000'007);
  CHECK(u32(packets[1], 16) == 1'000'000'009);
  // Radiotap of 24 B, MAC header, LLC/SNAP, "hi" and FCS.
  CHECK(u32(packets[0], 20) == 24 + 24 + 8 + 2 + 4);
  CHECK(captures.packets() == 2);
  CHECK(captures.packets_left_out() == 0);
  CHECK(blocks_of(file.octets(), kStatistics).size() == 1);
}

TEST_CASE("only captured nodes are wanted, and failures only on demand and by their FCS") {
  CaptureFile file;
  const bool failed = GENERATE(false, true);
  CaptureSetup setup = of_node_1(file);
  setup.failed = failed;
  const CaptureFiles captures{std::move(setup), encoder_of_two()};

  CHECK(captures.wants(1, LossCause::kNone));
  CHECK(captures.wants(1, LossCause::kInterference) == failed);
  CHECK_FALSE(captures.wants(1, LossCause::kCollision));  // never begun to be decoded
  CHECK_FALSE(captures.wants(0, LossCause::kNone));
}

TEST_CASE("a snap length cuts packets and keeps what they were") {
  CaptureFile file;
  CaptureSetup setup = of_node_1(file);
  setup.snap_length = 40;
  CaptureFiles captures{std::move(setup), encoder_of_two()};

  captures.add(received(SimTime{}), kEthernet);
  captures.finish();

  const auto packets = blocks_of(file.octets(), kEnhancedPacket);
  REQUIRE(packets.size() == 1);
  CHECK(u32(packets[0], 20) == 40);
  CHECK(u32(packets[0], 24) == 62);
}

TEST_CASE("more packets than the queue's memory are written, or counted as left out") {
  CaptureFile file;
  CaptureFiles captures{of_node_1(file), encoder_of_two()};
  const Octets large(1'514, 0xff);
  constexpr std::uint64_t kPackets = 50'000;  // 80 MB

  for (std::uint64_t i = 0; i < kPackets; ++i) {
    captures.add(received(SimTime{} + Duration{i}), large);
  }
  captures.finish();

  CHECK(captures.packets() + captures.packets_left_out() == kPackets);
  CHECK(blocks_of(file.octets(), kEnhancedPacket).size() == captures.packets());
  // The writer wakes every 50 ms at least; until then the queue of 32 MiB takes what comes.
  CHECK(captures.packets() > 15'000);
}

TEST_CASE("a file that can grow no more ends with a whole block, and the rest is counted") {
  CaptureFile file;
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  posix::check("getrlimit", ::getrlimit(RLIMIT_FSIZE, &before));
  CaptureFiles captures{of_node_1(file), encoder_of_two()};
  rlimit limit = before;
  limit.rlim_cur = 100'003;
  posix::check("setrlimit", ::setrlimit(RLIMIT_FSIZE, &limit));

  for (int i = 0; i < 5'000; ++i) {
    captures.add(received(SimTime{}), kEthernet);
  }
  captures.finish();
  posix::check("setrlimit", ::setrlimit(RLIMIT_FSIZE, &before));

  CHECK(captures.packets_left_out() > 0);
  CHECK(captures.packets() + captures.packets_left_out() == 5'000);
  CHECK(blocks_of(file.octets(), kEnhancedPacket).size() == captures.packets());
}

/// A recorder for node 1 and one frame whose payload is not read yet.
struct Bench {
  Bench() {
    frame = frames.add(0, static_cast<std::uint32_t>(kEthernet.size()), 0);
    auto captures = std::make_unique<CaptureFiles>(of_node_1(file), encoder_of_two());
    recorder.emplace(frames, std::move(captures), nullptr);
  }
  void hear(MacFrame::Kind kind) {
    PpduRecord record = received(SimTime{});
    record.ppdu.frame.kind = kind;
    record.ppdu.offer_id = frame;
    recorder->received(record.ppdu, record.reception);
  }

  CaptureFile file;
  FrameStore frames;
  std::uint32_t frame{};
  std::optional<PpduRecorder> recorder;
};

TEST_CASE("what was on the air before its payload was read waits for it, and what follows too") {
  Bench bench;
  bench.hear(MacFrame::Kind::kData);
  bench.hear(MacFrame::Kind::kAck);
  bench.recorder->hand_over();
  LiveFrame& frame = bench.frames[bench.frame];
  frame.air_done = true;
  CHECK(frame.records == 1);

  frame.payload = LiveFrame::Payload::kHere;
  frame.bytes = kEthernet;
  CHECK_FALSE(frame.over());
  bench.recorder->hand_over();
  bench.recorder->finish();

  CHECK(frame.records == 0);
  CHECK(bench.frames.in_use() == 0);
  const auto packets = blocks_of(bench.file.octets(), kEnhancedPacket);
  REQUIRE(packets.size() == 2);
  CHECK(u32(packets[0], 20) == 62);       // data
  CHECK(u32(packets[1], 20) == 24 + 14);  // ACK
}

TEST_CASE("a frame whose payload is lost is left out, and one that never comes too") {
  Bench bench;
  const bool lost = GENERATE(false, true);
  bench.hear(MacFrame::Kind::kData);
  if (lost) {
    bench.frames[bench.frame].payload = LiveFrame::Payload::kLost;
  }

  bench.recorder->finish();

  CHECK(bench.recorder->captures()->packets() == 0);
  CHECK(bench.recorder->captures()->packets_left_out() == 1);
}

}  // namespace
}  // namespace cuscus::netsim
