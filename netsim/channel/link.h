#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

/// An unordered pair of nodes and where their antennas are. Terms of the channel that know the ends
/// apart take `low` and `high`, and are thereby the same in both directions.
struct Link {
  std::uint32_t low;     ///< The smaller node number.
  std::uint32_t high;    ///< The larger one.
  Eigen::Vector3d p_WL;  ///< Antenna of `low`, world frame W (ENU) [m].
  Eigen::Vector3d p_WH;  ///< Antenna of `high`, likewise.

  [[nodiscard]] static Link between(std::uint32_t a, const Eigen::Vector3d& p_WA, std::uint32_t b,
                                    const Eigen::Vector3d& p_WB) {
    return a < b ? Link{a, b, p_WA, p_WB} : Link{b, a, p_WB, p_WA};
  }
};

/// One transmission over one link, for terms that change from frame to frame.
struct FrameOnLink {
  Link link;
  bool from_low;               ///< Whether `low` sends.
  std::uint64_t transmission;  ///< The sender's how-manieth, retries and ACKs included.
  SimTime time;                ///< Its beginning.
};

}  // namespace cuscus::netsim
