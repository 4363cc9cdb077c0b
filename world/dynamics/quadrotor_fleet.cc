#include "world/dynamics/quadrotor_fleet.h"

#include <cmath>

namespace cuscus::world {
namespace {

// Scalars, not Eigen: the loop over the lanes of a block is vectorised across vehicles.
struct Triple {
  double x, y, z;
};

struct Quaternion {
  double w, x, y, z;
};

struct State {
  Triple p;
  Triple v;
  Quaternion q;
  Triple w;
};

/// What stays constant during a step.
struct Body {
  double thrust_per_mass;
  Triple torque;
  double drag_lateral_per_mass;
  double drag_vertical_per_mass;
  Triple inertia;
  double gravity;
};

/// Body z axis in the world.
Triple up_axis(const Quaternion& q) {
  return {2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x),
          (q.w * q.w + q.z * q.z) - (q.x * q.x + q.y * q.y)};
}

inline State derivative(const State& s, const Body& body) {
  const Triple up = up_axis(s.q);
  const Triple& w = s.w;
  const Triple& inertia = body.inertia;
  return {.p = s.v,
          .v = {body.thrust_per_mass * up.x - body.drag_lateral_per_mass * s.v.x,
                body.thrust_per_mass * up.y - body.drag_lateral_per_mass * s.v.y,
                body.thrust_per_mass * up.z - body.drag_vertical_per_mass * s.v.z - body.gravity},
          .q = {-0.5 * (s.q.x * w.x + s.q.y * w.y + s.q.z * w.z),
                0.5 * (s.q.w * w.x + s.q.y * w.z - s.q.z * w.y),
                0.5 * (s.q.w * w.y + s.q.z * w.x - s.q.x * w.z),
                0.5 * (s.q.w * w.z + s.q.x * w.y - s.q.y * w.x)},
          .w = {(body.torque.x - (inertia.z - inertia.y) * w.y * w.z) / inertia.x,
                (body.torque.y - (inertia.x - inertia.z) * w.z * w.x) / inertia.y,
                (body.torque.z - (inertia.y - inertia.x) * w.x * w.y) / inertia.z}};
}

/// s + h d.
inline State moved(const State& s, double h, const State& d) {
  return {.p = {s.p.x + h * d.p.x, s.p.y + h * d.p.y, s.p.z + h * d.p.z},
          .v = {s.v.x + h * d.v.x, s.v.y + h * d.v.y, s.v.z + h * d.v.z},
          .q = {s.q.w + h * d.q.w, s.q.x + h * d.q.x, s.q.y + h * d.q.y, s.q.z + h * d.q.z},
          .w = {s.w.x + h * d.w.x, s.w.y + h * d.w.y, s.w.z + h * d.w.z}};
}

/// The classical Runge-Kutta step: s + h/6 (k1 + 2 k2 + 2 k3 + k4).
inline State advanced(const State& s, double h, const Body& body) {
  const State k1 = derivative(s, body);
  const State k2 = derivative(moved(s, 0.5 * h, k1), body);
  const State k3 = derivative(moved(s, 0.5 * h, k2), body);
  const State k4 = derivative(moved(s, h, k3), body);
  State next = moved(s, h / 6.0, k1);
  next = moved(next, h / 3.0, k2);
  next = moved(next, h / 3.0, k3);
  next = moved(next, h / 6.0, k4);
  const Quaternion& q = next.q;
  const double scale = 1.0 / std::sqrt((q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z));
  next.q = {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
  return next;
}

/// cos 45°: a vehicle that touches down with its up axis lower than this lies on its side.
constexpr double kTipOverCosine = 0.70710678118654752;

}  // namespace

QuadrotorFleet::QuadrotorFleet(std::span<const MultirotorParameters> vehicles,
                               const PlantSettings& settings)
    : settings_{settings},
      parameters_{vehicles.begin(), vehicles.end()},
      blocks_((vehicles.size() + kLanes - 1) / kLanes) {
  for (Block& block : blocks_) {
    block = Block{};
    for (Lanes* const ones : {&block.qw, &block.mass, &block.inertia_x, &block.inertia_y,
                              &block.inertia_z, &block.on_ground}) {
      ones->fill(1.0);
    }
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const MultirotorParameters& parameters = parameters_[i];
    check_parameters(parameters);
    Block& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    block.mass[lane] = parameters.mass_kg;
    block.drag_lateral[lane] = parameters.drag_lateral_Nspm;
    block.drag_vertical[lane] = parameters.drag_vertical_Nspm;
    block.inertia_x[lane] = parameters.inertia_roll_kgm2;
    block.inertia_y[lane] = parameters.inertia_pitch_kgm2;
    block.inertia_z[lane] = parameters.inertia_yaw_kgm2;
  }
}

void QuadrotorFleet::set_state(std::size_t vehicle, const RigidBodyState& state) {
  Block& block = blocks_[vehicle / kLanes];
  const std::size_t lane = vehicle % kLanes;
  block.px[lane] = state.p_WB_m.x();
  block.py[lane] = state.p_WB_m.y();
  block.pz[lane] = state.p_WB_m.z();
  block.vx[lane] = state.v_WB_W_mps.x();
  block.vy[lane] = state.v_WB_W_mps.y();
  block.vz[lane] = state.v_WB_W_mps.z();
  block.qw[lane] = state.q_WB.w();
  block.qx[lane] = state.q_WB.x();
  block.qy[lane] = state.q_WB.y();
  block.qz[lane] = state.q_WB.z();
  block.wx[lane] = state.w_WB_B_radps.x();
  block.wy[lane] = state.w_WB_B_radps.y();
  block.wz[lane] = state.w_WB_B_radps.z();
  block.on_ground[lane] = settings_.ground && state.p_WB_m.z() <= 0.0 &&
                                  state.v_WB_W_mps.isZero(0.0) && state.w_WB_B_radps.isZero(0.0)
                              ? 1.0
                              : 0.0;
}

void QuadrotorFleet::rest(std::size_t vehicle) {
  stand(blocks_[vehicle / kLanes], vehicle % kLanes);
}

RigidBodyState QuadrotorFleet::state(std::size_t vehicle) const {
  const Block& block = blocks_[vehicle / kLanes];
  const std::size_t lane = vehicle % kLanes;
  return {.p_WB_m = {block.px[lane], block.py[lane], block.pz[lane]},
          .v_WB_W_mps = {block.vx[lane], block.vy[lane], block.vz[lane]},
          .q_WB = {block.qw[lane], block.qx[lane], block.qy[lane], block.qz[lane]},
          .w_WB_B_radps = {block.wx[lane], block.wy[lane], block.wz[lane]}};
}

void QuadrotorFleet::set_commands(std::size_t vehicle, const RotorCommands& commands) {
  const RotorWrench wrench = rotor_wrench(parameters_[vehicle], commands);
  Block& block = blocks_[vehicle / kLanes];
  const std::size_t lane = vehicle % kLanes;
  block.thrust[lane] = wrench.thrust_N;
  block.torque_x[lane] = wrench.torque_x_Nm;
  block.torque_y[lane] = wrench.torque_y_Nm;
  block.torque_z[lane] = wrench.torque_z_Nm;
}

void QuadrotorFleet::step() {
  for (Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      block.on_ground[lane] = rests(block, lane) ? 1.0 : 0.0;
    }
    integrate(block);
    for (std::size_t lane = 0; settings_.ground && lane < kLanes; ++lane) {
      if (block.on_ground[lane] == 0.0 && block.pz[lane] <= 0.0) {
        block.pz[lane] = 0.0;
        stand(block, lane);
      }
    }
  }
}

bool QuadrotorFleet::rests(const Block& block, std::size_t lane) const noexcept {
  const Triple up = up_axis({block.qw[lane], block.qx[lane], block.qy[lane], block.qz[lane]});
  return block.on_ground[lane] != 0.0 &&
         block.thrust[lane] * up.z <= block.mass[lane] * settings_.gravity_mps2;
}

void QuadrotorFleet::integrate(Block& b) const noexcept {
  const double h = settings_.step_s;
  const double gravity = settings_.gravity_mps2;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const State now{.p = {b.px[i], b.py[i], b.pz[i]},
                    .v = {b.vx[i], b.vy[i], b.vz[i]},
                    .q = {b.qw[i], b.qx[i], b.qy[i], b.qz[i]},
                    .w = {b.wx[i], b.wy[i], b.wz[i]}};
    const Body body{.thrust_per_mass = b.thrust[i] / b.mass[i],
                    .torque = {b.torque_x[i], b.torque_y[i], b.torque_z[i]},
                    .drag_lateral_per_mass = b.drag_lateral[i] / b.mass[i],
                    .drag_vertical_per_mass = b.drag_vertical[i] / b.mass[i],
                    .inertia = {b.inertia_x[i], b.inertia_y[i], b.inertia_z[i]},
                    .gravity = gravity};
    const State next = advanced(now, h, body);
    const bool moves = b.on_ground[i] == 0.0;
    b.px[i] = moves ? next.p.x : now.p.x;
    b.py[i] = moves ? next.p.y : now.p.y;
    b.pz[i] = moves ? next.p.z : now.p.z;
    b.vx[i] = moves ? next.v.x : now.v.x;
    b.vy[i] = moves ? next.v.y : now.v.y;
    b.vz[i] = moves ? next.v.z : now.v.z;
    b.qw[i] = moves ? next.q.w : now.q.w;
    b.qx[i] = moves ? next.q.x : now.q.x;
    b.qy[i] = moves ? next.q.y : now.q.y;
    b.qz[i] = moves ? next.q.z : now.q.z;
    b.wx[i] = moves ? next.w.x : now.w.x;
    b.wy[i] = moves ? next.w.y : now.w.y;
    b.wz[i] = moves ? next.w.z : now.w.z;
  }
}

void QuadrotorFleet::stand(Block& block, std::size_t lane) noexcept {
  const Quaternion q{block.qw[lane], block.qx[lane], block.qy[lane], block.qz[lane]};
  for (Lanes* const speed : {&block.vx, &block.vy, &block.vz, &block.wx, &block.wy, &block.wz}) {
    (*speed)[lane] = 0.0;
  }
  const bool level = q.x == 0.0 && q.y == 0.0;
  if (!level && up_axis(q).z > kTipOverCosine) {
    // The turn of q about the vertical alone; its length is above cos 22.5°.
    const double scale = 1.0 / std::sqrt(q.w * q.w + q.z * q.z);
    block.qw[lane] = q.w * scale;
    block.qx[lane] = 0.0;
    block.qy[lane] = 0.0;
    block.qz[lane] = q.z * scale;
  }
  block.on_ground[lane] = 1.0;
}

bool QuadrotorFleet::on_ground(std::size_t vehicle) const {
  return blocks_[vehicle / kLanes].on_ground[vehicle % kLanes] != 0.0;
}

Eigen::Vector3d QuadrotorFleet::specific_force_mps2(std::size_t vehicle) const {
  const RigidBodyState body = state(vehicle);
  const Block& block = blocks_[vehicle / kLanes];
  const std::size_t lane = vehicle % kLanes;
  if (rests(block, lane)) {
    return body.q_WB.conjugate() * Eigen::Vector3d{0.0, 0.0, settings_.gravity_mps2};
  }
  const Eigen::Vector3d drag_W_N{-block.drag_lateral[lane] * body.v_WB_W_mps.x(),
                                 -block.drag_lateral[lane] * body.v_WB_W_mps.y(),
                                 -block.drag_vertical[lane] * body.v_WB_W_mps.z()};
  const Eigen::Vector3d thrust_B_N{0.0, 0.0, block.thrust[lane]};
  return (thrust_B_N + body.q_WB.conjugate() * drag_W_N) / block.mass[lane];
}

}  // namespace cuscus::world
