#include "camera/scene/frustum.h"

namespace cuscus::camera {

bool may_be_seen(const Tile& tile, const Eigen::Matrix4d& clip_from_world) {
  // Out of the picture when all corners are beyond the same side of it. What is behind is beyond
  // two sides at least, since w is the distance ahead.
  bool all_left = true;
  bool all_right = true;
  bool all_above = true;
  bool all_below = true;
  bool all_behind = true;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Eigen::Vector4d p_W{(corner & 1U) != 0 ? tile.high_m.x() : tile.low_m.x(),
                              (corner & 2U) != 0 ? tile.high_m.y() : tile.low_m.y(),
                              (corner & 4U) != 0 ? tile.high_m.z() : tile.low_m.z(), 1.0};
    const Eigen::Vector4d clip = clip_from_world * p_W;
    all_left = all_left && clip.x() < -clip.w();
    all_right = all_right && clip.x() > clip.w();
    all_above = all_above && clip.y() < -clip.w();
    all_below = all_below && clip.y() > clip.w();
    all_behind = all_behind && clip.w() < 0.0;
  }
  return !(all_left || all_right || all_above || all_below || all_behind);
}

}  // namespace cuscus::camera
