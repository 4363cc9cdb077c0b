#include "world/app/fleet_simulation.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <stdexcept>
#include <utility>

#include "world/app/configuration.h"
#include "world/dynamics/flair_fleet.h"
#include "world/dynamics/quadrotor_fleet.h"

namespace cuscus::world {
namespace {

constexpr std::int64_t kTallyPeriod_ns = 100'000'000;
constexpr std::int64_t kFixedNodePeriod_ns = 1'000'000'000;

std::array<double, 3> array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
std::array<double, 4> array_of(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

RigidBodyState start_of(const proto::WorldNode& node, const Surroundings& surroundings) {
  const proto::Vector3& p = node.p_wb_start_m();
  return {.p_WB_m = {p.x(), p.y(), surroundings.ground_m({p.x(), p.y()}) + p.z()},
          .q_WB = Eigen::Quaterniond{
              Eigen::AngleAxisd{node.yaw_start_rad(), Eigen::Vector3d::UnitZ()}}};
}

std::span<std::byte> sized(const posix::MemoryMapping& mapping, std::size_t byte_size,
                           const char* name) {
  if (mapping.bytes().size() != byte_size) {
    throw std::invalid_argument{std::string{name} + " has " +
                                std::to_string(mapping.bytes().size()) + " B, the run needs " +
                                std::to_string(byte_size)};
  }
  return mapping.writable_bytes();
}

const proto::WorldConfiguration& checked(const proto::WorldConfiguration& configuration) {
  check_configuration(configuration);
  return configuration;
}

Surroundings surroundings_of(const RunCity* city) {
  return city != nullptr ? Surroundings{&city->geometry} : Surroundings{};
}

std::uint64_t events(const shm::CommandTally& tally) {
  return tally.accepted + tally.rejected_not_finite + tally.rejected_out_of_range +
         tally.rejected_torn + tally.timeouts;
}

}  // namespace

FleetSimulation::FleetSimulation(const proto::WorldConfiguration& configuration, WorldMemory memory,
                                 const RunCity* city)
    : step_ns_{checked(configuration).step_ns()},
      memory_{std::move(memory)},
      slots_{slot_count(configuration)},
      fleet_{sized(memory_.fleet, shm::FleetMemoryWriter::byte_size(slots_), "fleet memory"),
             slots_},
      imu_schedule_{.period_ns = configuration.imu_period_ns(), .next = 0},
      motion_capture_schedule_{.period_ns = configuration.motion_capture_period_ns(), .next = 0} {
  if (memory_.motion_capture) {
    fleet_motion_capture_.emplace(
        sized(*memory_.motion_capture, shm::MotionCaptureMemoryWriter::byte_size(slots_),
              "motion-capture memory"),
        slots_);
  }
  const Surroundings surroundings = surroundings_of(city);
  std::vector<FleetCollisions::Member> members;
  add_vehicles(configuration, surroundings, members);
  collisions_.emplace(
      std::move(members), surroundings,
      city != nullptr ? std::span{city->buildings} : std::span<const std::string>{});
  add_views(configuration, city);
  for (const proto::WorldNode& node : configuration.nodes()) {
    if (!node.has_multirotor()) {
      const RigidBodyState start = start_of(node, surroundings);
      fixed_nodes_.push_back(
          {.node = node.node(),
           .state = {.sim_time_ns = 0,
                     .p_WB_m = array_of(start.p_WB_m),
                     .v_WB_W_mps = {},
                     .q_WB = array_of(start.q_WB),
                     .w_WB_B_radps = {},
                     .flags = node.p_wb_start_m().z() <= 0.0 ? shm::NodeFlag::kOnGround : 0}});
    }
  }
  for (const Vehicle& vehicle : vehicles_) {
    publish_state(vehicle);
    fleet_.publish(vehicle.node, vehicle.gate.tally());
  }
  publish_fixed_nodes();
  fleet_.publish_progress(0, 0, 0);
}

void FleetSimulation::add_vehicles(const proto::WorldConfiguration& configuration,
                                   const Surroundings& surroundings,
                                   std::vector<FleetCollisions::Member>& members) {
  const PlantSettings settings{.step_s = to_seconds(step_length()),
                               .gravity_mps2 = configuration.gravity_mps2(),
                               .ground = false};  // it is collisions_' matter
  for (const bool faithful : {false, true}) {
    std::vector<MultirotorParameters> parameters;
    std::vector<const proto::WorldNode*> nodes;
    for (const proto::WorldNode& node : configuration.nodes()) {
      if (node.has_multirotor() && node.multirotor().faithful() == faithful) {
        parameters.push_back(parameters_of(node.multirotor()));
        nodes.push_back(&node);
      }
    }
    if (nodes.empty()) {
      continue;
    }
    if (faithful) {
      plants_.push_back(std::make_unique<FlairFleet>(parameters, settings));
    } else {
      plants_.push_back(std::make_unique<QuadrotorFleet>(parameters, settings));
    }
    Plant& plant = *plants_.back();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const proto::WorldNode& node = *nodes[i];
      const WorldMemory::Vehicle& memory = memory_.vehicles.at(node.node());
      plant.set_state(i, start_of(node, surroundings));
      members.push_back({.node = node.node(),
                         .name = node.name(),
                         .plant = &plant,
                         .index = i,
                         .body = collision_body_of(node)});
      vehicles_.push_back(
          {.node = node.node(),
           .name = node.name(),
           .plant = &plant,
           .index = i,
           .member = members.size() - 1,
           .gate = CommandGate{SimClock::duration{node.multirotor().motor_timeout_ns()}},
           .sensors = shm::SensorMemoryWriter{sized(
               memory.sensors, shm::SensorMemoryWriter::byte_size(node.has_lidar()),
               "sensor memory")},
           .actuators = shm::ActuatorMemoryReader{memory.actuators.bytes()},
           .seen_version = 0,
           .published_tally = 0,
           .imu = {configuration.seed(),
                   node.node(),
                   {.gyro_radps = configuration.gyro_noise_radps(),
                    .accelerometer_mps2 = configuration.accelerometer_noise_mps2()}},
           .motion_capture = {configuration.seed(),
                              node.node(),
                              {.position_m = configuration.motion_capture_noise_m(),
                               .attitude_rad = configuration.motion_capture_noise_rad()}}});
    }
  }
}

void FleetSimulation::add_views(const proto::WorldConfiguration& configuration,
                                const RunCity* city) {
  const ViewSensors::Place place{
      .surroundings = surroundings_of(city),
      .origin = city != nullptr ? city->origin : site_of(configuration),
      .epoch = std::chrono::sys_seconds{std::chrono::seconds{configuration.epoch_unix_s()}}};
  for (const proto::WorldNode& node : configuration.nodes()) {
    if (!node.has_multirotor() || !ViewSensors::has_any(node)) {
      continue;
    }
    const auto vehicle = std::find_if(vehicles_.begin(), vehicles_.end(),
                                      [&](const Vehicle& one) { return one.node == node.node(); });
    views_.push_back({.member = vehicle->member,
                      .sensors = {configuration.seed(), node, place, vehicle->sensors}});
  }
}

void FleetSimulation::begin() {
  publish_readings();
  for (Vehicle& vehicle : vehicles_) {
    take_up_commands(vehicle);
  }
}

void FleetSimulation::step() {
  ++steps_;
  for (const auto& plant : plants_) {
    plant->step();
  }
  collisions_->step(time());
  for (const Vehicle& vehicle : vehicles_) {
    publish_state(vehicle);
  }
  publish_readings();
  for (Vehicle& vehicle : vehicles_) {
    take_up_commands(vehicle);
  }
  const std::int64_t now_ns = to_ns(time());
  if (now_ns % kTallyPeriod_ns < step_ns_) {
    publish_tallies();
  }
  if (now_ns % kFixedNodePeriod_ns < step_ns_) {
    publish_fixed_nodes();
  }
}

void FleetSimulation::publish_progress(std::uint64_t overruns) noexcept {
  fleet_.publish_progress(steps_, overruns, to_ns(time()));
}

void FleetSimulation::publish_state(const Vehicle& vehicle) noexcept {
  const RigidBodyState& body = collisions_->state(vehicle.member);
  const bool crashed = collisions_->has_crashed(vehicle.member);
  const auto& motors = vehicle.gate.motors();
  const bool running = !crashed && std::any_of(motors.begin(), motors.begin() + kRotors,
                                               [](double u) { return u > 0.0; });
  fleet_.publish(
      vehicle.node,
      shm::NodeState{
          .sim_time_ns = to_ns(time()),
          .p_WB_m = array_of(body.p_WB_m),
          .v_WB_W_mps = array_of(body.v_WB_W_mps),
          .q_WB = array_of(body.q_WB),
          .w_WB_B_radps = array_of(body.w_WB_B_radps),
          .flags = (vehicle.plant->on_ground(vehicle.index) ? shm::NodeFlag::kOnGround : 0) |
                   (running ? shm::NodeFlag::kMotorsRunning : 0) |
                   (crashed ? shm::NodeFlag::kCrashed : 0)});
}

void FleetSimulation::publish_fixed_nodes() noexcept {
  for (FixedNode& fixed : fixed_nodes_) {
    fixed.state.sim_time_ns = to_ns(time());
    fleet_.publish(fixed.node, fixed.state);
  }
}

void FleetSimulation::publish_readings() {
  for (View& view : views_) {
    view.sensors.publish(collisions_->state(view.member), time());
  }
  const auto imu = imu_schedule_.due(to_ns(time()));
  const auto motion_capture = motion_capture_schedule_.due(to_ns(time()));
  if (!imu && !motion_capture) {
    return;
  }
  for (Vehicle& vehicle : vehicles_) {
    const RigidBodyState& body = collisions_->state(vehicle.member);
    if (imu) {
      publish_imu(vehicle, body, *imu);
    }
    if (motion_capture) {
      publish_motion_capture(vehicle, body, *motion_capture);
    }
  }
}

void FleetSimulation::publish_imu(Vehicle& vehicle, const RigidBodyState& body,
                                  std::uint64_t reading) {
  const ImuSample sample = vehicle.imu.sample(
      {.angular_rate_B_radps = body.w_WB_B_radps,
       .specific_force_B_mps2 = vehicle.plant->specific_force_mps2(vehicle.index)},
      reading);
  vehicle.sensors.publish(
      shm::ImuReading{.sim_time_ns = to_ns(time()),
                      .sequence = reading + 1,
                      .angular_rate_B_radps = array_of(sample.angular_rate_B_radps),
                      .specific_force_B_mps2 = array_of(sample.specific_force_B_mps2)});
}

void FleetSimulation::publish_motion_capture(Vehicle& vehicle, const RigidBodyState& body,
                                             std::uint64_t reading) {
  const MotionCaptureSample sample =
      vehicle.motion_capture.sample({.p_WB_m = body.p_WB_m, .q_WB = body.q_WB}, reading);
  const shm::MotionCaptureReading message{.sim_time_ns = to_ns(time()),
                                          .sequence = reading + 1,
                                          .p_WB_m = array_of(sample.p_WB_m),
                                          .q_WB = array_of(sample.q_WB)};
  vehicle.sensors.publish(message);
  if (fleet_motion_capture_) {
    fleet_motion_capture_->publish(vehicle.node, message);
  }
}

void FleetSimulation::take_up_commands(Vehicle& vehicle) {
  const std::uint64_t version = vehicle.actuators.version();
  const bool was_driven = vehicle.gate.driven();
  const std::uint64_t were_accepted = vehicle.gate.tally().accepted;
  if (version != vehicle.seen_version) {
    // Taken before the load: what is written during it has a higher version and is read next time.
    vehicle.seen_version = version;
    vehicle.gate.offer(time(), vehicle.actuators.command());
  }
  vehicle.gate.expire(time());
  const bool changed =
      vehicle.gate.tally().accepted != were_accepted || vehicle.gate.driven() != was_driven;
  if (changed && !collisions_->has_crashed(vehicle.member)) {
    RotorCommands commands{};
    std::copy_n(vehicle.gate.motors().begin(), kRotors, commands.begin());
    vehicle.plant->set_commands(vehicle.index, commands);
  }
}

void FleetSimulation::publish_tallies() noexcept {
  for (Vehicle& vehicle : vehicles_) {
    const std::uint64_t now = events(vehicle.gate.tally());
    if (now != vehicle.published_tally) {
      vehicle.published_tally = now;
      fleet_.publish(vehicle.node, vehicle.gate.tally());
    }
  }
}

std::vector<FleetSimulation::NodeTally> FleetSimulation::tallies() const {
  std::vector<NodeTally> tallies;
  tallies.reserve(vehicles_.size());
  for (const Vehicle& vehicle : vehicles_) {
    tallies.push_back({.name = vehicle.name, .commands = vehicle.gate.tally()});
  }
  return tallies;
}

}  // namespace cuscus::world
