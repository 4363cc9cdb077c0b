// Plays the orchestrator, world, radio and fleet for a real cuscus-gcs, so that its page can be
// looked at without privileges: page_harness --gcs <path> [--uavs N] [--duration-s S] [--failed
// UAV] [--blocks N] [--attribution TEXT]. UAV number --failed says that it is in failsafe; N blocks
// of a city stand in rows from the corner (20 m, 20 m) on, whose data are those of TEXT.
//
// Prints {"url": ..., "gcs_pid": ...} once the page is up. Runs until standard input ends or says a
// line; then stops the ground station and prints {"exit_code": ..., "stop_ms": ..., report}.

#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/city/transfer/city_message.h"
#include "common/ipc/control_socket.h"
#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/shared_memory.h"
#include "proto/air.pb.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/radio_memory.h"

namespace {

using namespace cuscus;

constexpr double kRadius_m = 40.0;
constexpr double kAltitude_m = 12.0;
constexpr double kSpeed_mps = 3.0;
constexpr std::int64_t kStep_ns = 20'000'000;
constexpr std::int64_t kTelemetryPeriod_ns = 100'000'000;

struct Options {
  std::string gcs;
  std::uint32_t uavs{10};
  std::int64_t duration_s{60};
  std::optional<std::uint32_t> failed;
  std::size_t blocks{0};
  std::string attribution;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    if (name == "--gcs") {
      options.gcs = argv[i + 1];
    } else if (name == "--uavs") {
      options.uavs = static_cast<std::uint32_t>(std::stoul(argv[i + 1]));
    } else if (name == "--duration-s") {
      options.duration_s = std::stol(argv[i + 1]);
    } else if (name == "--failed") {
      options.failed = static_cast<std::uint32_t>(std::stoul(argv[i + 1]));
    } else if (name == "--blocks") {
      options.blocks = std::stoul(argv[i + 1]);
    } else if (name == "--attribution") {
      options.attribution = argv[i + 1];
    } else {
      throw std::invalid_argument{"unknown option " + std::string{name}};
    }
  }
  if (options.gcs.empty()) {
    throw std::invalid_argument{
        "usage: page_harness --gcs <path> [--uavs N] [--duration-s S] [--failed UAV] "
        "[--blocks N] [--attribution TEXT]"};
  }
  return options;
}

/// A socket bound to 127.0.0.1 on a port that the kernel chooses.
posix::UniqueFd bound_socket(int type, std::uint16_t& port) {
  posix::UniqueFd fd{posix::check("socket", ::socket(AF_INET, type | SOCK_CLOEXEC, 0))};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  posix::check("bind", ::bind(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address));
  socklen_t size = sizeof address;
  posix::check("getsockname",
               ::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&address), &size));
  port = ntohs(address.sin_port);
  return fd;
}

std::uint16_t free_udp_port() {
  std::uint16_t port = 0;
  bound_socket(SOCK_DGRAM, port);
  return port;
}

/// The ground station as a child process, seen from the orchestrator.
class Child {
 public:
  explicit Child(const std::string& program) {
    auto [parent, child] = ipc::ControlSocket::pair();
    socket_.emplace(std::move(parent));
    pid_ = posix::check("fork", ::fork());
    if (pid_ == 0) {
      ::fcntl(child.fd(), F_SETFD, 0);
      // Still the only thread.
      // NOLINTNEXTLINE(concurrency-mt-unsafe)
      ::setenv("CUSCUS_CONTROL_FD", std::to_string(child.fd()).c_str(), 1);
      ::execl(program.c_str(), program.c_str(), nullptr);
      std::perror(program.c_str());
      ::_exit(127);
    }
  }

  ipc::ControlSocket& socket() { return *socket_; }
  [[nodiscard]] pid_t pid() const { return pid_; }

  int wait() {
    int status = 0;
    posix::check("waitpid", ::waitpid(pid_, &status, 0));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  std::optional<ipc::ControlSocket> socket_;
  pid_t pid_{-1};
};

/// Everything around the ground station.
class Surroundings {
 public:
  Surroundings(std::uint32_t uavs, std::optional<std::uint32_t> failed)
      : uavs_{uavs},
        failed_{failed},
        fleet_fd_{
            posix::create_shared_memory("fleet", shm::FleetMemoryWriter::byte_size(uavs + 1))},
        radio_fd_{
            posix::create_shared_memory("radio", shm::RadioMemoryWriter::byte_size(uavs + 1))},
        fleet_mapping_{posix::MemoryMapping::read_write(fleet_fd_)},
        radio_mapping_{posix::MemoryMapping::read_write(radio_fd_)},
        fleet_{fleet_mapping_.writable_bytes(), uavs + 1},
        radio_{radio_mapping_.writable_bytes(), uavs + 1},
        positions_(uavs + 1) {
    std::uint16_t ignored = 0;
    sender_ = bound_socket(SOCK_DGRAM, ignored);
  }

  [[nodiscard]] int fleet_fd() const { return fleet_fd_.get(); }
  [[nodiscard]] int radio_fd() const { return radio_fd_.get(); }

  void step(std::int64_t now_ns, std::uint16_t telemetry_port) {
    move(now_ns);
    transmit(now_ns);
    if (now_ns >= next_telemetry_ns_) {
      next_telemetry_ns_ = now_ns + kTelemetryPeriod_ns;
      for (std::uint32_t uav = 0; uav < uavs_; ++uav) {
        tell(uav, now_ns, telemetry_port);
      }
      // A Telemetry whose state is no UTF-8, then bytes that are nothing at all.
      const std::array<unsigned char, 9> garbage{0x5A, 0x02, 0xFF, 0xFE, 0xFF,
                                                 0x13, 0x80, 0x80, 0x00};
      send(garbage.data(), 4, telemetry_port);
      send(garbage.data(), garbage.size(), telemetry_port);
      ++sequence_;
    }
  }

 private:
  [[nodiscard]] double angle(std::uint32_t uav, double t_s) const {
    return 2.0 * std::numbers::pi * uav / uavs_ + kSpeed_mps / kRadius_m * t_s;
  }

  void move(std::int64_t now_ns) {
    const double t_s = static_cast<double>(now_ns) * 1e-9;
    for (std::uint32_t node = 0; node <= uavs_; ++node) {
      shm::NodeState state{};
      state.sim_time_ns = now_ns;
      state.q_WB = {1.0, 0.0, 0.0, 0.0};
      state.p_WB_m = {-10.0, -62.0, 1.5};  // the ground station
      if (node < uavs_) {
        const double phi = angle(node, t_s);
        const double wobble_m = 1.5 * std::sin(0.7 * t_s + node);
        const double yaw = phi + std::numbers::pi / 2;
        state.p_WB_m = {(kRadius_m + wobble_m) * std::cos(phi),
                        (kRadius_m + wobble_m) * std::sin(phi), kAltitude_m + 0.3 * wobble_m};
        state.v_WB_W_mps = {kSpeed_mps * std::cos(yaw), kSpeed_mps * std::sin(yaw), 0.0};
        state.q_WB = {std::cos(yaw / 2), 0.0, 0.0, std::sin(yaw / 2)};
        state.flags = shm::NodeFlag::kMotorsRunning;
      }
      positions_[node] = state;
      fleet_.publish(node, state);
    }
    fleet_.publish_progress(static_cast<std::uint64_t>(now_ns / 1'000'000), 0, now_ns);
  }

  /// Everybody hears every UAV whose frames come in above -91 dBm (log-distance, n = 3.5). The
  /// ground station has nothing to send, as a real one.
  void transmit(std::int64_t now_ns) {
    ++frames_;
    for (std::uint32_t receiver = 0; receiver <= uavs_; ++receiver) {
      shm::RadioTally tally{};
      if (receiver < uavs_) {
        tally.offered = frames_ * 2;
        tally.transmissions = frames_ * 2 + frames_ / 9;
        tally.retries = frames_ / 9;
      }
      for (std::uint32_t sender = 0; sender < uavs_; ++sender) {
        if (sender == receiver) {
          continue;
        }
        const auto& a = positions_[receiver].p_WB_m;
        const auto& b = positions_[sender].p_WB_m;
        const double d_m = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        const double level_dbm = 16.0 - 40.2 - 35.0 * std::log10(std::max(1.0, d_m));
        if (level_dbm < -91.0) {
          tally.lost_below_detection += frames_;
          continue;
        }
        tally.received += frames_ - frames_ / 50;
        tally.lost_collision += frames_ / 50;
        radio_.publish_link(receiver, sender,
                            {.received_dbm = static_cast<float>(level_dbm),
                             .rate_kbps = 6'000,
                             .sim_time_ms = static_cast<std::uint32_t>(now_ns / 1'000'000)});
      }
      radio_.publish(receiver, tally);
    }
    radio_.publish(shm::RadioTiming{.release_lateness_p50_ns = 4'200,
                                    .release_lateness_p99_ns = 61'000,
                                    .release_lateness_max_ns = 742'000,
                                    .releases = frames_ * uavs_,
                                    .clamps = 0,
                                    .events = frames_});
    radio_.beat(now_ns);
  }

  void tell(std::uint32_t uav, std::int64_t now_ns, std::uint16_t port) {
    // The share of lost telemetry grows with the UAV's number, up to 12 %.
    const std::uint32_t lost_of_100 = 12 * uav / uavs_;
    if ((sequence_ * 37 + uav * 11) % 100 < lost_of_100) {
      return;
    }
    const shm::NodeState& truth = positions_[uav];
    proto::Telemetry message;
    message.set_node(uav);
    message.set_sequence(sequence_);
    message.set_sim_time_ns(static_cast<std::uint64_t>(now_ns));
    message.set_x_m(static_cast<float>(truth.p_WB_m[0] + 0.4));
    message.set_y_m(static_cast<float>(truth.p_WB_m[1] - 0.3));
    message.set_z_m(static_cast<float>(truth.p_WB_m[2]));
    message.set_vx_mps(static_cast<float>(truth.v_WB_W_mps[0]));
    message.set_vy_mps(static_cast<float>(truth.v_WB_W_mps[1]));
    message.set_yaw_rad(static_cast<float>(2.0 * std::atan2(truth.q_WB[3], truth.q_WB[0])));
    message.set_state(uav == failed_ ? "failsafe" : "flying");
    message.set_neighbours_heard(uavs_ - 1);
    const std::string bytes = message.SerializeAsString();
    send(bytes.data(), bytes.size(), port);
  }

  void send(const void* bytes, std::size_t size, std::uint16_t port) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(port);
    // A refused datagram is one that the ground station will count as lost.
    static_cast<void>(
        ::sendto(sender_.get(), bytes, size, 0, reinterpret_cast<sockaddr*>(&to), sizeof to));
  }

  std::uint32_t uavs_;
  std::optional<std::uint32_t> failed_;
  posix::UniqueFd fleet_fd_;
  posix::UniqueFd radio_fd_;
  posix::MemoryMapping fleet_mapping_;
  posix::MemoryMapping radio_mapping_;
  shm::FleetMemoryWriter fleet_;
  shm::RadioMemoryWriter radio_;
  std::vector<shm::NodeState> positions_;
  posix::UniqueFd sender_;
  std::int64_t next_telemetry_ns_{0};
  std::uint32_t sequence_{0};
  std::uint64_t frames_{0};
};

void give(ipc::ControlSocket& socket, proto::Descriptors::Kind kind, int fd) {
  proto::Envelope envelope;
  envelope.mutable_descriptors()->add_items()->set_kind(kind);
  socket.send(envelope, std::array{fd});
}

/// Blocks of 12 m with a courtyard of 4 m, every 16 m, in rows of as many as there are rows; the
/// height grows to the east.
city::City city_of(const Options& options) {
  constexpr double kFirst_m = 20.0;
  constexpr double kPitch_m = 16.0;
  const auto square = [](double west_m, double south_m, double side_m) {
    return city::Ring{{west_m, south_m},
                      {west_m + side_m, south_m},
                      {west_m + side_m, south_m + side_m},
                      {west_m, south_m + side_m}};
  };
  city::City city;
  city.attribution = options.attribution;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(options.blocks)));
  for (std::size_t block = 0; block < options.blocks; ++block) {
    const auto column = static_cast<double>(block % side);
    const double x_m = kFirst_m + kPitch_m * column;
    const double y_m = kFirst_m + kPitch_m * static_cast<double>(block / side);
    city::Ring courtyard = square(x_m + 4.0, y_m + 4.0, 4.0);
    std::reverse(courtyard.begin(), courtyard.end());
    city::Building building;
    building.osm_id = static_cast<std::int64_t>(block) + 1;
    building.prisms.push_back({.footprint = {square(x_m, y_m, 12.0), {std::move(courtyard)}},
                               .bottom_m = 0.0,
                               .top_m = 10.0 + column});
    city.buildings.push_back(std::move(building));
  }
  const double end_m = kFirst_m + kPitch_m * static_cast<double>(side);
  city.north_east_m = {end_m, end_m};
  return city;
}

posix::UniqueFd memory_of(const city::City& city) {
  const std::string message = city::to_message(city).SerializeAsString();
  posix::UniqueFd fd = posix::create_shared_memory("city", message.size());
  auto mapping = posix::MemoryMapping::read_write(fd);
  std::memcpy(mapping.writable_bytes().data(), message.data(), message.size());
  return fd;
}

proto::Envelope configuration(const Options& options, std::uint16_t telemetry_port) {
  proto::Envelope envelope;
  auto* const station = envelope.mutable_configure()->mutable_ground_station();
  station->set_node(options.uavs);
  station->set_telemetry_port(telemetry_port);
  station->set_scenario_name("Circle of " + std::to_string(options.uavs) + " <quadrotors>");
  station->set_run_id("harness-" + std::to_string(::getpid()));
  station->set_duration_ns(options.duration_s * 1'000'000'000);
  for (std::uint32_t node = 0; node <= options.uavs; ++node) {
    auto* const item = station->add_nodes();
    const bool is_vehicle = node < options.uavs;
    item->set_node(node);
    item->set_name(is_vehicle ? "uav" + std::to_string(node) : "ground-station");
    item->set_address("10.0.0." + std::to_string(node + 1));
    item->set_is_vehicle(is_vehicle);
  }
  auto* const circle = station->mutable_circle();
  circle->mutable_p_wc_centre_m()->set_z(kAltitude_m);
  circle->set_radius_m(kRadius_m);
  circle->set_speed_mps(kSpeed_mps);
  return envelope;
}

/// Brings the ground station to Ready; false when its telemetry port was taken in between.
bool bring_up(Child& child, const Options& options, const Surroundings& surroundings,
              int listener_fd, std::uint16_t telemetry_port) {
  give(child.socket(), proto::Descriptors::KIND_FLEET_MEMORY, surroundings.fleet_fd());
  give(child.socket(), proto::Descriptors::KIND_RADIO_MEMORY, surroundings.radio_fd());
  give(child.socket(), proto::Descriptors::KIND_PAGE_LISTENER, listener_fd);
  if (options.blocks > 0) {
    give(child.socket(), proto::Descriptors::KIND_CITY, memory_of(city_of(options)).get());
  }
  child.socket().send(configuration(options, telemetry_port));
  const proto::Envelope answer = child.socket().receive().envelope;
  if (answer.has_failure()) {
    std::cerr << "ground station: " << answer.failure().text() << '\n';
    return false;
  }
  return answer.has_ready();
}

/// Whether standard input has something, or its end; waits until `deadline_ns` for it.
bool told_to_stop(std::int64_t deadline_ns) {
  const std::int64_t wait_ms = (deadline_ns - posix::monotonic_now_ns()) / 1'000'000;
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  return ::poll(&input, 1, static_cast<int>(std::max<std::int64_t>(0, wait_ms))) > 0;
}

void stop_and_tell(Child& child) {
  const std::int64_t before_ns = posix::monotonic_now_ns();
  proto::Envelope stop;
  stop.mutable_stop()->set_reason("asked to");
  child.socket().send(stop);
  proto::Envelope envelope;
  while (!envelope.has_report()) {
    envelope = child.socket().receive().envelope;
  }
  const int exit_code = child.wait();
  const auto& report = envelope.report().ground_station();
  std::cout << "{\"exit_code\": " << exit_code
            << ", \"stop_ms\": " << (posix::monotonic_now_ns() - before_ns) / 1'000'000
            << ", \"telemetry_received\": " << report.telemetry_received()
            << ", \"telemetry_rejected\": " << report.telemetry_rejected()
            << ", \"page_clients\": " << report.page_clients() << ", \"cpu_s\": " << report.cpu_s()
            << "}" << std::endl;
}

void run(const Options& options) {
  constexpr int kAttempts = 5;
  std::uint16_t page_port = 0;
  const posix::UniqueFd listener = bound_socket(SOCK_STREAM, page_port);
  posix::check("listen", ::listen(listener.get(), SOMAXCONN));
  Surroundings surroundings{options.uavs, options.failed};
  std::optional<Child> child;
  std::uint16_t telemetry_port = 0;
  for (int attempt = 0; !child; ++attempt) {
    telemetry_port = free_udp_port();
    child.emplace(options.gcs);
    if (!bring_up(*child, options, surroundings, listener.get(), telemetry_port)) {
      child->wait();
      child.reset();
      if (attempt == kAttempts) {
        throw std::runtime_error{"the ground station does not come up"};
      }
    }
  }
  const std::int64_t start_ns = posix::monotonic_now_ns();
  proto::Envelope start;
  start.mutable_start()->set_start_monotonic_ns(start_ns);
  child->socket().send(start);
  std::cout << "{\"url\": \"http://127.0.0.1:" << page_port << "\", \"gcs_pid\": " << child->pid()
            << "}" << std::endl;

  std::int64_t next_ns = start_ns;
  while (!told_to_stop(next_ns)) {
    surroundings.step(posix::monotonic_now_ns() - start_ns, telemetry_port);
    next_ns += kStep_ns;
    while (child->socket().try_receive()) {
    }
  }
  stop_and_tell(*child);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "page_harness: " << error.what() << '\n';
    return 1;
  }
}
