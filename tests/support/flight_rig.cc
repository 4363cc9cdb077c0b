#include "tests/support/flight_rig.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "common/random/counter_stream.h"
#include "uav-agent/missions/angle.h"

namespace cuscus::tests {
namespace {

constexpr SimClock::duration kMillisecond = std::chrono::milliseconds{1};
constexpr std::uint16_t kStartPurpose = 0x7e01;
constexpr std::uint16_t kPhasePurpose = 0x7e02;
constexpr std::uint16_t kLossPurpose = 0x7e03;

std::vector<world::MultirotorParameters> plants(const FlightRig::Settings& settings) {
  std::vector<world::MultirotorParameters> result;
  for (const double mass_kg : settings.masses_kg) {
    result.push_back(world::flair_x4(mass_kg));
  }
  return result;
}

FlightRig::Settings rig_settings(const CircleFleet::Settings& settings) {
  FlightRig::Settings rig;
  rig.seed = settings.seed;
  rig.masses_kg.assign(settings.fleet_size, settings.mass_kg);
  rig.nominal_mass_kg = settings.nominal_mass_kg;
  rig.p_WB_start_m.clear();
  for (std::uint32_t i = 0; i < settings.fleet_size; ++i) {
    const missions::CircleMission slot{settings.circle, i, settings.fleet_size};
    const random::CounterStream stream{settings.seed, random::stream_id(kStartPurpose, i)};
    const Eigen::Vector3d scatter{2.0 * stream.uniform(0) - 1.0, 2.0 * stream.uniform(1) - 1.0,
                                  0.0};
    Eigen::Vector3d start_m = slot.entry_point_m() + settings.start_scatter_m * scatter;
    start_m.z() = 0.0;
    rig.p_WB_start_m.push_back(start_m);
  }
  return rig;
}

}  // namespace

FlightRig::FlightRig(const Settings& settings) {
  const auto parameters = plants(settings);
  plant_ = std::make_unique<world::QuadrotorFleet>(
      parameters, world::PlantSettings{.step_s = 0.001, .gravity_mps2 = kGravity_mps2});
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    plant_->set_state(i, {.p_WB_m = settings.p_WB_start_m.at(i)});
    const auto node = static_cast<std::uint32_t>(i);
    sensors_.push_back(
        {.imu = world::Imu{settings.seed,
                           node,
                           {.gyro_radps = settings.gyro_noise_radps,
                            .accelerometer_mps2 = settings.accelerometer_noise_mps2}},
         .motion_capture = world::MotionCapture{settings.seed,
                                                node,
                                                {.position_m = settings.position_noise_m,
                                                 .attitude_rad = settings.attitude_noise_rad}}});
    flight::Airframe airframe;
    airframe.mass_kg = settings.nominal_mass_kg.value_or(settings.masses_kg[i]);
    flight::AutopilotParameters autopilot;
    autopilot.estimator.position_noise_m =
        std::max(autopilot.estimator.position_noise_m, settings.position_noise_m);
    pilots_.emplace_back(airframe, autopilot);
  }
}

void FlightRig::read_sensors() {
  for (std::size_t i = 0; i < size(); ++i) {
    auto& sensors = sensors_[i];
    const world::RigidBodyState state = truth(i);
    if (milliseconds_ % 5 == 0 && !sensors.imu_silent) {
      const auto sample =
          sensors.imu.sample({.angular_rate_B_radps = state.w_WB_B_radps,
                              .specific_force_B_mps2 = plant_->specific_force_mps2(i)},
                             milliseconds_ / 5);
      sensors.inertial = {.time = now_,
                          .sequence = milliseconds_ / 5,
                          .angular_rate_B_radps = sample.angular_rate_B_radps,
                          .specific_force_B_mps2 = sample.specific_force_B_mps2};
    }
    if (milliseconds_ % 10 == 0 && !sensors.capture_silent) {
      const auto sample = sensors.motion_capture.sample(
          {.p_WB_m = state.p_WB_m, .q_WB = state.q_WB}, milliseconds_ / 10);
      sensors.capture = {.time = now_,
                         .sequence = milliseconds_ / 10,
                         .p_WB_m = sample.p_WB_m,
                         .q_WB = sample.q_WB};
    }
  }
}

void FlightRig::step(const Guidance& guidance) {
  plant_->step();
  ++milliseconds_;
  now_ += kMillisecond;
  read_sensors();
  for (std::size_t i = 0; i < size(); ++i) {
    if (milliseconds_ % 5 != (3 * i) % 5) {
      continue;
    }
    pilots_[i].sense(now_, sensors_[i].inertial, sensors_[i].capture);
    std::optional<flight::Setpoint> setpoint;
    if (pilots_[i].state() == flight::FlightState::kFlying) {
      setpoint = guidance(i, now_);
    }
    plant_->set_commands(i, pilots_[i].act(now_, setpoint));
  }
}

CircleFleet::CircleFleet(const Settings& settings)
    : settings_{settings}, rig_{rig_settings(settings)}, sequences_(settings.fleet_size) {
  for (std::uint32_t i = 0; i < settings.fleet_size; ++i) {
    missions_.emplace_back(settings.circle, i, settings.fleet_size);
    tables_.emplace_back(i, settings.fleet_size, settings.neighbour_timeout);
    const random::CounterStream stream{settings.seed, random::stream_id(kPhasePurpose, i)};
    const auto period = settings.beacon_period.value_or(kMillisecond);
    next_beacon_.push_back(SimTime{SimClock::duration{
        static_cast<std::int64_t>(stream.uniform(0) * static_cast<double>(period.count()))}});
    rig_.pilot(i).take_off(settings.circle.p_WC_centre_m.z());
  }
}

void CircleFleet::fly_until(double seconds, const std::function<void()>& observe) {
  const SimTime end{
      std::chrono::duration_cast<SimClock::duration>(std::chrono::duration<double>{seconds})};
  for (std::uint64_t i = 1; rig_.now() < end; ++i) {
    rig_.step([this](std::size_t vehicle, SimTime now) { return guide(vehicle, now); });
    if (settings_.beacon_period) {
      deliver_beacons();
      send_beacons();
    }
    if (observe && i % 10 == 0) {
      observe();
    }
  }
}

flight::Setpoint CircleFleet::guide(std::size_t vehicle, SimTime now) {
  if (!settings_.beacon_period) {
    look_at_fleet(vehicle, now);
  }
  const auto& pilot = rig_.pilot(vehicle);
  return missions_[vehicle].setpoint(
      now, pilot.estimate(), missions::neighbour_angles(tables_[vehicle], now, settings_.circle),
      pilot.heading_rad());
}

void CircleFleet::look_at_fleet(std::size_t vehicle, SimTime now) {
  const auto n = settings_.fleet_size;
  const auto own = static_cast<std::uint32_t>(vehicle);
  for (const std::uint32_t slot : {(own + n - 1) % n, (own + 1) % n}) {
    if (const auto& capture = rig_.capture(slot)) {
      static_cast<void>(
          tables_[vehicle].accept({.slot = slot,
                                   .sequence = static_cast<std::uint32_t>(capture->sequence),
                                   .time = capture->time,
                                   .p_WB_m = capture->p_WB_m},
                                  now));
    }
  }
}

void CircleFleet::send_beacons() {
  for (std::uint32_t slot = 0; slot < settings_.fleet_size; ++slot) {
    const auto& pilot = rig_.pilot(slot);
    if (rig_.now() < next_beacon_[slot] || !pilot.ready()) {
      continue;
    }
    next_beacon_[slot] += *settings_.beacon_period;
    in_flight_.push_back({.arrival = rig_.now() + settings_.beacon_delay,
                          .report = {.slot = slot,
                                     .sequence = ++sequences_[slot],
                                     .time = pilot.estimate().time,
                                     .p_WB_m = pilot.estimate().p_WB_m}});
  }
}

void CircleFleet::deliver_beacons() {
  const random::CounterStream losses{settings_.seed, random::stream_id(kLossPurpose, 0)};
  std::erase_if(in_flight_, [&](const InFlight& beacon) {
    if (beacon.arrival > rig_.now()) {
      return false;
    }
    for (auto& table : tables_) {
      if (losses.uniform(losses_drawn_++) >= settings_.beacon_loss) {
        static_cast<void>(table.accept(beacon.report, rig_.now()));
      }
    }
    return true;
  });
}

std::vector<double> CircleFleet::formation_errors_m() const {
  const auto& circle = settings_.circle;
  const auto n = settings_.fleet_size;
  std::complex<double> sum{};
  for (std::uint32_t i = 0; i < n; ++i) {
    sum += std::polar(
        1.0, missions::angle_of(rig_.truth(i).p_WB_m, circle) - missions::kTurn_rad * i / n);
  }
  std::vector<double> errors;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle_rad = std::arg(sum) + missions::kTurn_rad * i / n;
    const Eigen::Vector3d place_m =
        circle.p_WC_centre_m +
        circle.radius_m * Eigen::Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0.0};
    errors.push_back((rig_.truth(i).p_WB_m - place_m).norm());
  }
  return errors;
}

std::vector<double> CircleFleet::radial_errors_m() const {
  std::vector<double> errors;
  for (std::uint32_t i = 0; i < settings_.fleet_size; ++i) {
    const Eigen::Vector3d offset_m = rig_.truth(i).p_WB_m - settings_.circle.p_WC_centre_m;
    errors.push_back(
        std::hypot(offset_m.head<2>().norm() - settings_.circle.radius_m, offset_m.z()));
  }
  return errors;
}

double CircleFleet::closest_pair_m() const {
  double closest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rig_.size(); ++i) {
    for (std::size_t j = i + 1; j < rig_.size(); ++j) {
      closest_m = std::min(closest_m, (rig_.truth(i).p_WB_m - rig_.truth(j).p_WB_m).norm());
    }
  }
  return closest_m;
}

bool CircleFleet::all_circling() const {
  return std::all_of(missions_.begin(), missions_.end(),
                     [](const auto& mission) { return mission.circling(); });
}

}  // namespace cuscus::tests
