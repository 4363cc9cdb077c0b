// cuscus-netsim as the orchestrator runs it: a process with a control socket and descriptors.
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <string>

#include "common/ipc/control_socket.h"
#include "common/posix/shared_memory.h"
#include "netsim/app/frame_record.h"
#include "proto/shm/clock_page.h"
#include "proto/shm/fleet_memory.h"
#include "tests/netns/tap_node.h"

namespace cuscus::netsim {
namespace {

using ipc::ControlSocket;
using posix::check;
using posix::MemoryMapping;
using posix::UniqueFd;
using Kind = proto::Descriptors;

constexpr std::uint32_t kNodes = 2;

proto::RadioConfiguration configuration() {
  proto::RadioConfiguration c;
  c.set_seed(1);
  c.set_standard("802.11g");
  c.set_data_rate_kbps(6'000);
  c.set_group_rate_kbps(6'000);
  for (const std::uint32_t rate : {6'000U, 12'000U, 24'000U}) {
    c.add_basic_rates_kbps(rate);
  }
  c.set_carrier_hz(2.412e9);
  c.set_noise_figure_db(7.0);
  c.set_slot_ns(20'000);
  c.set_retry_limit(7);
  c.set_long_retry_limit(7);
  c.set_rate_control("constant");
  c.set_rts_threshold_bytes(0xffffffff);
  c.set_mac("dcf");
  c.set_queue_frames(500);
  c.set_queue_lifetime_ns(500'000'000);
  c.set_error_model("nist");
  c.set_cca_preamble_dbm(-82.0);
  c.set_cca_energy_dbm(-62.0);
  c.set_detection_minimum_dbm(-82.0);
  c.set_detection_minimum_sinr_db(4.0);
  c.set_capture_in_preamble_db(std::numeric_limits<double>::infinity());
  c.set_capture_in_frame_db(std::numeric_limits<double>::infinity());
  c.mutable_propagation()->set_model("friis");
  c.mutable_propagation()->set_fading("none");
  for (std::uint32_t i = 0; i < kNodes; ++i) {
    auto* const node = c.add_nodes();
    node->set_node(i);
    node->set_name("uav" + std::to_string(i));
    const auto mac = test_mac(i);
    node->set_mac(std::string{mac.begin(), mac.end()});
    node->set_tx_power_dbm(16.0);
  }
  return c;
}

/// The emulator's process and what an orchestrator holds of it.
class Emulator {
 public:
  explicit Emulator(const proto::RadioConfiguration& radio) {
    auto [ours, theirs] = ControlSocket::pair();
    socket_.emplace(std::move(ours));
    // A duplicate without close-on-exec is the child's.
    const UniqueFd inherited{check("fcntl", ::fcntl(theirs.fd(), F_DUPFD, 100))};
    const std::string variable = "CUSCUS_CONTROL_FD=" + std::to_string(inherited.get());
    std::string program = CUSCUS_NETSIM;
    std::array<char*, 2> arguments{program.data(), nullptr};
    std::string environment = variable;
    std::array<char*, 2> environments{environment.data(), nullptr};
    const int error = ::posix_spawn(&pid_, program.c_str(), nullptr, nullptr, arguments.data(),
                                    environments.data());
    REQUIRE(error == 0);
    proto::Envelope envelope;
    *envelope.mutable_configure()->mutable_radio() = radio;
    configure_ = envelope;
  }
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;
  Emulator(Emulator&&) = delete;
  Emulator& operator=(Emulator&&) = delete;
  ~Emulator() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }

  void give(Kind::Kind kind, std::uint32_t node, const UniqueFd& fd) {
    proto::Envelope envelope;
    auto* const item = envelope.mutable_descriptors()->add_items();
    item->set_kind(kind);
    item->set_node(node);
    const std::array<int, 1> descriptors{fd.get()};
    socket_->send(envelope, descriptors);
  }
  void configure() { socket_->send(configure_); }
  void send(const proto::Envelope& envelope) { socket_->send(envelope); }

  /// The next message that is no heartbeat.
  proto::Envelope receive() {
    for (;;) {
      auto received = socket_->receive();
      if (!received.envelope.has_status()) {
        return received.envelope;
      }
      ++heartbeats;
    }
  }
  int exit_code() {
    int status = 0;
    check("waitpid", ::waitpid(std::exchange(pid_, -1), &status, 0));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// Closes the socket without a word.
  int abandon() {
    socket_.reset();
    return exit_code();
  }

  int heartbeats{0};

 private:
  std::optional<ControlSocket> socket_;
  pid_t pid_{-1};
  proto::Envelope configure_;
};

/// Two nodes and the memories of a run.
struct World {
  World() {
    for (std::uint32_t i = 0; i < kNodes; ++i) {
      nodes[i].space.run([&] { set_up(nodes[i], i); });
    }
    fleet.publish(1, shm::NodeState{.sim_time_ns = 0,
                                    .p_WB_m = {30.0, 0.0, 0.0},
                                    .v_WB_W_mps = {},
                                    .q_WB = {1.0, 0.0, 0.0, 0.0},
                                    .w_WB_B_radps = {},
                                    .flags = 0});
    fleet.publish_progress(1, 0, 0);
  }

  std::array<TapNode, kNodes> nodes;
  UniqueFd clock_fd = posix::create_shared_memory("clock", shm::ClockPageWriter::byte_size());
  UniqueFd fleet_fd =
      posix::create_shared_memory("fleet", shm::FleetMemoryWriter::byte_size(kNodes));
  UniqueFd radio_fd =
      posix::create_shared_memory("radio", shm::RadioMemoryWriter::byte_size(kNodes));
  UniqueFd log_fd{check("memfd_create", ::memfd_create("frames", MFD_CLOEXEC))};
  MemoryMapping clock_memory = MemoryMapping::read_write(clock_fd);
  MemoryMapping fleet_memory = MemoryMapping::read_write(fleet_fd);
  shm::ClockPageWriter clock{clock_memory.writable_bytes()};
  shm::FleetMemoryWriter fleet{fleet_memory.writable_bytes(), kNodes};
};

void give_all(Emulator& emulator, World& world) {
  emulator.give(Kind::KIND_CLOCK_PAGE, 0, world.clock_fd);
  emulator.give(Kind::KIND_FLEET_MEMORY, 0, world.fleet_fd);
  emulator.give(Kind::KIND_RADIO_MEMORY, 0, world.radio_fd);
  emulator.give(Kind::KIND_FRAME_LOG, 0, world.log_fd);
  for (std::uint32_t i = 0; i < kNodes; ++i) {
    emulator.give(Kind::KIND_TAP, i, world.nodes[i].tap);
  }
  emulator.configure();
}

TEST_CASE("the emulator's process lives from Configure to Report and logs its frames") {
  World world;
  Emulator emulator{configuration()};
  give_all(emulator, world);
  REQUIRE(emulator.receive().has_ready());
  proto::Envelope start;
  start.mutable_start()->set_start_monotonic_ns(posix::monotonic_now_ns() + 50'000'000);
  emulator.send(start);
  posix::sleep_until_monotonic(start.start().start_monotonic_ns() + 5'000'000);

  const std::string text = "through a process";
  const sockaddr_in everybody = test_address(255);
  check("sendto", ::sendto(world.nodes[0].socket.get(), text.data(), text.size(), 0,
                           reinterpret_cast<const sockaddr*>(&everybody), sizeof everybody));
  pollfd ready{.fd = world.nodes[1].socket.get(), .events = POLLIN, .revents = 0};
  REQUIRE(::poll(&ready, 1, 5'000) == 1);
  proto::Envelope stop;
  stop.mutable_stop()->set_reason("test");
  emulator.send(stop);
  const proto::Envelope report = emulator.receive();

  REQUIRE(report.has_report());
  CHECK(report.report().radio().release_lateness().count() == 1);
  CHECK(report.report().radio().send_stamps() == "read");
  REQUIRE(report.report().radio().nodes_size() == kNodes);
  CHECK(report.report().radio().nodes(0).queue_high_water() == 1);
  CHECK(report.report().radio().nodes(1).releases() == 1);
  CHECK(emulator.exit_code() == 0);
  CHECK(emulator.heartbeats >= 1);
  const MemoryMapping radio = MemoryMapping::read_only(world.radio_fd);
  const shm::RadioMemoryReader memory{radio.bytes()};
  CHECK(memory.tally(1)->received == 1);
  // 16 dBm less free space at 30 m: where the world put the node.
  CHECK(memory.link(1, 0)->received_dbm == Approx(16.0 - 69.64).margin(0.05));
  std::ifstream log{"/proc/self/fd/" + std::to_string(world.log_fd.get())};
  std::string line;
  std::string last;
  while (std::getline(log, line)) {
    last = line;
  }
  const auto record = parse_frame_record(last);
  REQUIRE(record);
  CHECK(record->outcome == SendOutcome::kSent);
  CHECK(record->deliveries == 1);
}

TEST_CASE("a configuration that cannot be is answered with a Failure that says why") {
  World world;
  auto radio = configuration();
  radio.set_error_model("gut-feeling");
  Emulator emulator{radio};
  give_all(emulator, world);

  const proto::Envelope answer = emulator.receive();

  REQUIRE(answer.has_failure());
  CHECK_THAT(answer.failure().text(), Catch::Contains("'gut-feeling'"));
  CHECK(emulator.exit_code() == 1);
}

TEST_CASE("the emulator ends when the orchestrator is gone") {
  World world;
  Emulator emulator{configuration()};
  give_all(emulator, world);
  REQUIRE(emulator.receive().has_ready());

  CHECK(emulator.abandon() == 1);
}

}  // namespace
}  // namespace cuscus::netsim
