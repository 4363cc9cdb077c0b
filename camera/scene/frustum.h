#pragma once

#include <Eigen/Core>

#include "camera/scene/scene.h"

namespace cuscus::camera {

/// Whether something of `tile` may be in the picture whose clip space `clip_from_world` leads to
/// (Pinhole::clip_from_camera): never false when something is.
[[nodiscard]] bool may_be_seen(const Tile& tile, const Eigen::Matrix4d& clip_from_world);

}  // namespace cuscus::camera
