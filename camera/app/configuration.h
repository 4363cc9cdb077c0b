#pragma once

#include "camera/gl/renderer.h"
#include "camera/view/pinhole.h"
#include "proto/configuration.pb.h"
#include "proto/shm/camera_memory.h"

namespace cuscus::camera {

/// @throws std::invalid_argument naming the camera and what is wrong with it.
void check_configuration(const proto::CameraConfiguration& configuration);

[[nodiscard]] Pinhole pinhole_of(const proto::CameraNode& camera);
[[nodiscard]] CameraMount mount_of(const proto::CameraNode& camera);
[[nodiscard]] shm::PictureShape shape_of(const Pinhole& camera);

}  // namespace cuscus::camera
