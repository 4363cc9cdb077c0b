// Beacons of an agent over real UDP sockets, in a network namespace of the test's own.
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <iostream>
#include <optional>
#include <string>

#include "common/posix/check.h"
#include "common/posix/network_namespace.h"
#include "uav-agent/air/air_messages.h"
#include "uav-agent/app/agent.h"

namespace cuscus::agent {
namespace {

constexpr std::uint32_t kPort = 4711;

/// Stands on the ground for ever.
class StandingVehicle final : public sdk::Vehicle,
                              private sdk::Clock,
                              private sdk::Sensors,
                              private sdk::Actuators,
                              private sdk::Radio {
 public:
  SimTime time;

  [[nodiscard]] const sdk::Clock& clock() const override { return *this; }
  [[nodiscard]] const sdk::Sensors& sensors() const override { return *this; }
  [[nodiscard]] sdk::Actuators& actuators() override { return *this; }
  [[nodiscard]] const sdk::Radio& radio() const override { return *this; }
  [[nodiscard]] const sdk::FleetMotionCapture* fleet() const override { return nullptr; }

 private:
  [[nodiscard]] SimTime now() const override { return time; }
  [[nodiscard]] std::vector<sdk::Neighbour> neighbours() const override { return {}; }
  [[nodiscard]] std::optional<Decibel> link_budget(std::uint32_t) const override { return {}; }
  void sleep_until(SimTime) const override {}
  [[nodiscard]] std::optional<sdk::ImuReading> imu() const override {
    return sdk::ImuReading{.time = time, .specific_force_B_mps2 = {0.0, 0.0, 9.81}};
  }
  [[nodiscard]] std::optional<sdk::MotionCaptureReading> motion_capture() const override {
    return sdk::MotionCaptureReading{.time = time};
  }
  void set_motors(const sdk::MotorCommands&, SimTime) override {}
};

proto::AgentConfiguration configuration() {
  proto::AgentConfiguration result;
  result.set_slot(1);
  result.set_fleet_size(4);
  result.set_control_period_ns(5'000'000);
  result.mutable_circle()->mutable_p_wc_centre_m()->set_z(10.0);
  result.mutable_circle()->set_radius_m(20.0);
  result.mutable_circle()->set_speed_mps(2.0);
  result.set_beacon_period_ns(50'000'000);
  result.set_beacon_port(kPort);
  result.set_beacon_address("127.255.255.255");
  result.set_neighbour_timeout_ns(3'000'000'000);
  return result;
}

void raise_loopback() {
  const posix::UniqueFd fd{posix::check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  ifreq request{};
  std::memcpy(request.ifr_name, "lo", 3);
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  posix::check("raise lo", ::ioctl(fd.get(), SIOCSIFFLAGS, &request));
}

void run_for(Agent& agent, StandingVehicle& vehicle, SimClock::duration duration) {
  const SimTime end = vehicle.time + duration;
  while (agent.deadline() < end) {
    vehicle.time = agent.deadline();
    agent.run(vehicle.time);
  }
}

std::string beacon_of(std::uint32_t slot) {
  return air::encoded(air::Beacon{
      .report = {.slot = slot, .sequence = 1, .time = sim_time(1), .p_WB_m = {1.0, 2.0, 3.0}}});
}

/// A namespace, or nothing where the kernel does not let us make one.
std::optional<posix::NetworkNamespace> own_namespace() {
  try {
    return posix::NetworkNamespace::create();
  } catch (const std::system_error& error) {
    std::cerr << "SKIPPED: no network namespace: " << error.what() << '\n';
    return std::nullopt;
  }
}

TEST_CASE("an agent broadcasts beacons, hears those of others, and ignores its own") {
  const auto own = own_namespace();
  if (!own) {
    return;
  }
  proto::AgentReport report;
  own->run([&] {
    raise_loopback();
    StandingVehicle vehicle;
    Agent agent{configuration(), vehicle};
    DatagramSocket other{0};
    const sockaddr_in to = endpoint("127.255.255.255", kPort);
    const std::string garbage = "GET / HTTP/1.1\r\n\r\n";
    const std::string too_long = beacon_of(0) + std::string(1000, 'x');
    // Slots 0 and 2, then what must be rejected: no such slot, no beacon, too long.
    for (const std::string& payload :
         {beacon_of(0), beacon_of(2), beacon_of(9), garbage, too_long}) {
      REQUIRE(other.try_send(payload, to));
    }
    run_for(agent, vehicle, std::chrono::seconds{1});
    report = agent.report();
  });

  CHECK(report.beacons_received() == 2);
  CHECK(report.beacons_rejected() == 3);
  CHECK(report.beacons_sent() >= 18);
  CHECK(report.beacons_sent() <= 21);
}

TEST_CASE("an agent whose network is down counts what it cannot send and flies on") {
  const auto own = own_namespace();
  if (!own) {
    return;
  }
  proto::AgentReport report;
  std::uint64_t send_errors = 0;
  own->run([&] {
    StandingVehicle vehicle;
    Agent agent{configuration(), vehicle};
    run_for(agent, vehicle, std::chrono::seconds{1});
    report = agent.report();
    send_errors = agent.send_errors();
  });

  CHECK(report.beacons_sent() == 0);
  CHECK(send_errors >= 18);
  CHECK(report.loops() >= 199);
  CHECK(report.final_state() == "taking-off");
}

}  // namespace
}  // namespace cuscus::agent
