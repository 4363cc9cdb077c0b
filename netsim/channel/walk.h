#pragma once

#include <functional>

#include "netsim/channel/antenna.h"
#include "netsim/channel/channel.h"

namespace cuscus::netsim {

/// Node 1 walks straight on while node 0 stands; both are level and face east. World frame W (ENU).
struct Walk {
  Eigen::Vector3d p_WF{Eigen::Vector3d::Zero()};  ///< Where node 0 stands [m].
  Eigen::Vector3d p_WB{Eigen::Vector3d::Zero()};  ///< Where the walk begins [m].
  Eigen::Vector3d p_WE{Eigen::Vector3d::Zero()};  ///< Where it ends [m].
  double step_m{1.0};                             ///< Above 0.
  double speed_mps{1.0};                          ///< Above 0.
};

/// The channel at one step of a walk.
struct WalkPoint {
  double way_m;          ///< From the beginning.
  Eigen::Vector3d p_WM;  ///< Of node 1 [m].
  double distance_m;
  StaticTerms fixed;
  FrameTerms frame;  ///< Of a frame that node 1 sends here, its how-manieth being the step's.
  Decibel antennas;  ///< Gains of both ends.

  [[nodiscard]] Decibel loss() const { return fixed.sum() + frame.sum() - antennas; }
};

/// Visits the steps from the beginning on, up to the last one that is not beyond the end; time
/// begins at 0. `antenna` may be null: isotropic.
/// @throws std::invalid_argument when step or speed are not above 0, or would make more than 10^7
/// steps.
void along(const Walk& walk, const Channel& channel, const Antenna* antenna,
           const std::function<void(const WalkPoint&)>& visit);

}  // namespace cuscus::netsim
