#include "uav-agent/app/agent.h"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <stdexcept>

#include "uav-agent/app/agent_settings.h"

namespace cuscus::agent {
namespace {

constexpr std::uint32_t kFleet = 4;

/// A vehicle whose sensors say what the test wants.
class ScriptedVehicle final : public sdk::Vehicle,
                              private sdk::Clock,
                              private sdk::Sensors,
                              private sdk::Actuators,
                              private sdk::FleetMotionCapture,
                              private sdk::Radio {
 public:
  SimTime time;
  std::optional<sdk::ImuReading> inertial;
  std::optional<sdk::MotionCaptureReading> capture;
  std::vector<sdk::MotorCommands> commands;
  std::vector<std::uint32_t> looked_at;

  [[nodiscard]] const sdk::Clock& clock() const override { return *this; }
  [[nodiscard]] const sdk::Sensors& sensors() const override { return *this; }
  [[nodiscard]] sdk::Actuators& actuators() override { return *this; }
  [[nodiscard]] const sdk::Radio& radio() const override { return *this; }
  [[nodiscard]] const sdk::FleetMotionCapture* fleet() const override { return this; }

  void stand_at(SimTime now) {
    time = now;
    inertial = sdk::ImuReading{.time = now, .specific_force_B_mps2 = {0.0, 0.0, 9.81}};
    capture = sdk::MotionCaptureReading{.time = now};
  }

 private:
  [[nodiscard]] SimTime now() const override { return time; }
  [[nodiscard]] std::vector<sdk::Neighbour> neighbours() const override { return {}; }
  [[nodiscard]] std::optional<Decibel> link_budget(std::uint32_t) const override { return {}; }
  void sleep_until(SimTime) const override {}
  [[nodiscard]] std::optional<sdk::ImuReading> imu() const override { return inertial; }
  [[nodiscard]] std::optional<sdk::MotionCaptureReading> motion_capture() const override {
    return capture;
  }
  [[nodiscard]] std::optional<sdk::MotionCaptureReading> motion_capture_of(
      std::uint32_t node) const override {
    const_cast<ScriptedVehicle*>(this)->looked_at.push_back(node);
    return sdk::MotionCaptureReading{.time = time, .sequence = 1};
  }
  void set_motors(const sdk::MotorCommands& motors, SimTime) override {
    commands.push_back(motors);
  }
};

proto::AgentConfiguration configuration() {
  proto::AgentConfiguration result;
  result.set_node(1);
  result.set_name("uav1");
  result.set_slot(1);
  result.set_fleet_size(kFleet);
  result.set_seed(1);
  result.set_control_period_ns(5'000'000);
  result.mutable_circle()->mutable_p_wc_centre_m()->set_z(10.0);
  result.mutable_circle()->set_radius_m(20.0);
  result.mutable_circle()->set_speed_mps(2.0);
  result.mutable_circle()->set_spacing_gain(0.5);
  result.set_beacon_period_ns(50'000'000);
  // Port 0 lets the kernel choose what to bind to; nothing can be sent to it.
  result.set_beacon_port(0);
  result.set_beacon_address("127.0.0.1");
  result.set_neighbour_timeout_ns(3'000'000'000);
  for (std::uint32_t slot = 0; slot < kFleet; ++slot) {
    result.add_slot_nodes(slot + 10);
  }
  return result;
}

TEST_CASE("an agent controls its vehicle in every control period and reports how often") {
  ScriptedVehicle vehicle;
  Agent agent{configuration(), vehicle};

  for (int i = 0; i < 300; ++i) {
    vehicle.stand_at(agent.deadline());
    agent.run(agent.deadline());
  }

  const auto report = agent.report();
  CHECK(report.loops() == vehicle.commands.size());
  CHECK(report.loops() > 250);
  CHECK(report.overruns() == 0);
  CHECK(report.final_state() == "taking-off");
  CHECK(vehicle.commands.back()[0] > 0.0);
}

TEST_CASE("missed control periods are counted") {
  ScriptedVehicle vehicle;
  Agent agent{configuration(), vehicle};

  agent.run(SimTime{std::chrono::milliseconds{5}});
  agent.run(SimTime{std::chrono::milliseconds{55}});

  CHECK(agent.report().overruns() == 9);
}

TEST_CASE("what cannot be sent is counted and does not keep an agent from flying") {
  ScriptedVehicle vehicle;
  Agent agent{configuration(), vehicle};

  for (int i = 0; i < 2200; ++i) {
    vehicle.stand_at(agent.deadline());
    agent.run(agent.deadline());
  }

  // Ten seconds of 50 ms: sendto() to port 0 fails with EINVAL.
  CHECK(agent.report().beacons_sent() == 0);
  CHECK(agent.send_errors() > 190);
  CHECK(agent.report().loops() > 1900);
}

TEST_CASE("an agent that knows its neighbours by motion capture looks at their nodes") {
  ScriptedVehicle vehicle;
  auto by_capture = configuration();
  by_capture.set_neighbours(proto::AgentConfiguration::NEIGHBOURS_MOTION_CAPTURE);
  by_capture.set_beacon_period_ns(0);
  Agent agent{by_capture, vehicle};

  vehicle.stand_at(agent.deadline());
  agent.run(agent.deadline());

  CHECK(vehicle.looked_at == std::vector<std::uint32_t>{10, 12});
}

TEST_CASE("a failsafe is reported with its reason") {
  ScriptedVehicle vehicle;
  Agent agent{configuration(), vehicle};
  vehicle.stand_at(agent.deadline());
  for (int i = 0; i < 100; ++i) {
    agent.run(agent.deadline());  // the readings stay the same
  }

  CHECK(agent.report().final_state() == "failsafe");
  CHECK(agent.report().failsafes() == 1);
  CHECK(agent.report().sensors_lost());
  CHECK_FALSE(agent.report().last_failsafe_reason().empty());
}

TEST_CASE("a configuration that cannot be flown is refused before anything is opened") {
  using Spoil = std::function<void(proto::AgentConfiguration&)>;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Spoil> spoils{
      [](auto& c) { c.set_fleet_size(0); },
      [](auto& c) { c.set_slot(kFleet); },
      [](auto& c) { c.set_control_period_ns(0); },
      [](auto& c) { c.mutable_circle()->set_radius_m(0.0); },
      [&](auto& c) { c.mutable_circle()->set_speed_mps(nan); },
      [](auto& c) { c.mutable_circle()->set_spacing_gain(-1.0); },
      [](auto& c) { c.mutable_circle()->mutable_p_wc_centre_m()->set_z(0.0); },
      [](auto& c) { c.set_neighbour_timeout_ns(0); },
      [](auto& c) { c.set_motion_capture_noise_m(-0.1); },
      [](auto& c) { c.set_beacon_port(70'000); },
      [](auto& c) { c.set_beacon_period_ns(0); },
      [](auto& c) { c.set_beacon_address("not an address"); },
      [](auto& c) { c.set_telemetry_address("10.0.0.1"); },
      [](auto& c) { c.mutable_multirotor()->set_mass_kg(-1.0); },
      [](auto& c) { c.mutable_multirotor()->set_drag_lateral(-0.1); },
      [](auto& c) {
        c.set_neighbours(proto::AgentConfiguration::NEIGHBOURS_MOTION_CAPTURE);
        c.clear_slot_nodes();
      }};
  ScriptedVehicle vehicle;

  for (const auto& spoil : spoils) {
    auto spoiled = configuration();
    spoil(spoiled);
    CHECK_THROWS_AS((Agent{spoiled, vehicle}), std::invalid_argument);
  }
}

TEST_CASE("nominal parameters come from the configuration, and from FL-AIR where it is silent") {
  auto given = configuration();
  given.mutable_multirotor()->set_mass_kg(2.0);
  given.set_gravity_mps2(9.7);

  const flight::Airframe result = airframe(given);

  CHECK(result.mass_kg == 2.0);
  CHECK(result.gravity_mps2 == 9.7);
  CHECK(result.arm_m == 0.2);
  CHECK(result.motor_speed_per_command == 86.0);
}

TEST_CASE("the estimator is told how noisy motion capture is, where that is more than its least") {
  auto given = configuration();
  CHECK(autopilot_parameters(given).estimator.position_noise_m == 0.002);

  given.set_motion_capture_noise_m(0.0002);
  CHECK(autopilot_parameters(given).estimator.position_noise_m == 0.002);

  given.set_motion_capture_noise_m(0.05);
  CHECK(autopilot_parameters(given).estimator.position_noise_m == 0.05);
}

TEST_CASE("a lateral drag of 0 is a drag, not a parameter that was left out") {
  auto given = configuration();
  CHECK(airframe(given).drag_lateral == 0.4);

  given.mutable_multirotor()->set_drag_lateral(0.0);

  CHECK(airframe(given).drag_lateral == 0.0);
}

}  // namespace
}  // namespace cuscus::agent
