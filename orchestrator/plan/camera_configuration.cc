#include "orchestrator/plan/camera_configuration.h"

#include <cstddef>
#include <variant>

#include "orchestrator/plan/world_configuration.h"

namespace cuscus::orchestrator {
namespace {

// As cameras see them: vehicles as wide as what collides, other nodes as a box.
constexpr double kBodyHeight_m = 0.12;
constexpr double kFixedSide_m = 0.5;

scenario::Position_m body_size_m(const scenario::X4Vehicle* x4) {
  return x4 == nullptr ? scenario::Position_m{kFixedSide_m, kFixedSide_m, kFixedSide_m}
                       : scenario::Position_m{2.0 * x4->collision.radius_m,
                                              2.0 * x4->collision.radius_m, kBodyHeight_m};
}

proto::CameraNode camera_of(const scenario::CameraSensor& from, const NodePlan& node) {
  proto::CameraNode camera;
  camera.set_node(node.index);
  camera.set_name(node.name);
  camera.set_period_ns(from.period.count());
  camera.set_width_px(from.width_px);
  camera.set_height_px(from.height_px);
  camera.set_field_rad(from.field_rad);
  *camera.mutable_p_bc_m() = vector_of(from.offset_m);
  camera.set_roll_rad(from.direction.roll_rad);
  camera.set_pitch_rad(from.direction.pitch_rad);
  camera.set_yaw_rad(from.direction.yaw_rad);
  return camera;
}

}  // namespace

std::optional<proto::CameraConfiguration> camera_configuration(const scenario::Scenario& scenario,
                                                               std::span<const NodePlan> nodes) {
  proto::CameraConfiguration cameras;
  std::size_t next = 0;
  const auto add_body = [&](const NodePlan& node, const scenario::X4Vehicle* x4) {
    proto::CameraBody& body = *cameras.add_bodies();
    body.set_node(node.index);
    *body.mutable_size_m() = vector_of(body_size_m(x4));
  };
  for (const scenario::Group& group : scenario.fleet) {
    const auto* x4 = std::get_if<scenario::X4Vehicle>(&group.vehicle);
    for (std::uint32_t member = 0; member < group.count; ++member) {
      const NodePlan& node = nodes[next++];
      add_body(node, x4);
      if (x4 != nullptr && x4->sensors.camera) {
        *cameras.add_cameras() = camera_of(*x4->sensors.camera, node);
      }
    }
  }
  if (next < nodes.size()) {
    add_body(nodes[next], nullptr);
  }
  if (cameras.cameras_size() == 0) {
    return std::nullopt;
  }
  return cameras;
}

}  // namespace cuscus::orchestrator
