#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "camera/scene/scene.h"
#include "camera/view/pinhole.h"

namespace cuscus::camera {

/// Another vehicle as a camera sees it: a box.
struct Body {
  Eigen::Vector3d size_m{0.6, 0.6, 0.12};
  Eigen::Vector3d p_WB_m{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond q_WB{Eigen::Quaterniond::Identity()};
};

/// Draws pictures of a scene. Needs a SurfacelessContext that is current for all of its life.
class Renderer {
 public:
  /// What is nearer than that is not seen.
  static constexpr double kNear_m = 0.05;

  explicit Renderer(const Scene& scene);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The picture that `camera` at `pose` has of the scene and of `bodies`, RGB8, row by row from
  /// the top: 3 x width x height bytes.
  void draw(const Pinhole& camera, const CameraPose& pose, std::span<const Body> bodies,
            std::span<std::byte> rgb);

 private:
  /// Where pictures of one size are drawn.
  struct Target {
    unsigned framebuffer;
    unsigned colour;
    unsigned depth;
  };

  const Target& target_of(const Pinhole& camera);
  void draw_background(const Pinhole& camera, const CameraPose& pose);
  void draw_scene(const Eigen::Matrix4d& clip_from_world);
  void draw_body(const Body& body, const Eigen::Matrix4d& clip_from_world);

  std::vector<Tile> tiles_;
  bool has_flat_ground_;
  unsigned background_program_;
  unsigned solid_program_;
  unsigned scene_array_{0};
  unsigned scene_buffer_{0};
  unsigned box_array_{0};
  unsigned box_buffer_{0};
  int box_vertices_{0};
  std::map<std::pair<std::uint32_t, std::uint32_t>, Target> targets_;
};

}  // namespace cuscus::camera
