#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/units/sim_time.h"
#include "world/collision/close_pairs.h"
#include "world/collision/collision_body.h"
#include "world/collision/encounter.h"
#include "world/collision/passage.h"
#include "world/dynamics/plant.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

/// What a vehicle hit.
struct Struck {
  enum class Kind : std::uint8_t { kBuilding, kGround, kTree, kWood, kVehicle };

  Kind kind{Kind::kGround};
  std::uint32_t index{0};  ///< In the City's list of that kind, or of the other vehicle.

  friend bool operator==(const Struck&, const Struck&) = default;
};

/// The beginning of a contact. Landing is none.
struct CollisionEvent {
  std::uint32_t vehicle{0};
  Struck struck;
  Eigen::Vector3d p_WB_m;  ///< Of the vehicle.
  double speed_mps{0.0};   ///< Towards what it hit.
  bool crash{false};       ///< Its motors must not run from now on.
};

/// Keeps the vehicles of a fleet out of the city, the ground and one another.
///
/// Each step takes the vehicles' balls straight from where they were after the last to where
/// dynamics would have them: first past one another, in the order in which they meet, then each
/// past all that stands still. Vehicles that a contact moved may overlap by a fraction of their
/// step until the next, which lets them part only.
///
/// Far from everything a vehicle costs the length of its way and a comparison: the distance to the
/// nearest surface is kept, less the way gone since, and surroundings are asked only when it is
/// used up.
class Collisions final {
 public:
  /// What a step made of a vehicle that touched something.
  struct Moved {
    std::uint32_t vehicle;
    bool rests;  ///< Something carries it: it must stand until its thrust exceeds its weight.
  };

  /// `bodies`: one per vehicle.
  Collisions(std::vector<CollisionBody> bodies, Surroundings surroundings);

  /// Puts a vehicle somewhere without asking what is in between.
  void place(std::uint32_t vehicle, const Eigen::Vector3d& p_WB_m);
  /// What a vehicle at `p_WB_m` would be in, if anything.
  [[nodiscard]] std::optional<city::Surface> in_the_way(std::uint32_t vehicle,
                                                        const Eigen::Vector3d& p_WB_m) const;
  /// Whether a vehicle at `p_WB_m` touches something that carries it.
  [[nodiscard]] bool stands(std::uint32_t vehicle, const Eigen::Vector3d& p_WB_m) const;

  /// `states`: where dynamics would have each vehicle at `now`; position and velocity of those in
  /// moved() are changed.
  void step(std::span<RigidBodyState> states, SimTime now);

  /// Of the latest step; a vehicle is there at most once.
  [[nodiscard]] std::span<const Moved> moved() const { return moved_; }
  [[nodiscard]] std::span<const CollisionEvent> events() const { return events_; }

 private:
  /// The bodies that a vehicle has touched lately, so that one contact is not many.
  struct Recent {
    Struck struck;
    SimTime until;
  };
  struct Meeting {
    double t;
    BallPair pair;
  };

  [[nodiscard]] Eigen::Vector3d centre(std::size_t vehicle, const Eigen::Vector3d& p_WB_m) const;
  [[nodiscard]] MovingBall ball(std::size_t vehicle, const RigidBodyState& state) const;
  double measure_ways(std::span<const RigidBodyState> states);
  void pass_one_another(std::span<RigidBodyState> states, double most_way_m, SimTime now);
  void meet(const BallPair& pair, std::span<RigidBodyState> states, SimTime now);
  void pass_surroundings(std::size_t vehicle, RigidBodyState& state, SimTime now);
  [[nodiscard]] bool is_free(std::size_t vehicle);
  void divert(std::size_t vehicle, RigidBodyState& state, const Eigen::Vector3d& p_WC,
              const Eigen::Vector3d& v_mps, bool rests);
  void note(std::size_t vehicle, const Struck& struck, const RigidBodyState& state,
            double speed_mps, SimTime now);
  [[nodiscard]] bool begins(std::size_t vehicle, const Struck& struck, SimTime now);

  std::vector<CollisionBody> bodies_;
  Surroundings surroundings_;
  ClosePairs close_pairs_;
  std::vector<Eigen::Vector3d> centres_;  // after the last step
  std::vector<double> way_m_;             // in this step
  std::vector<double> free_m_;            // way until something could be touched
  std::vector<std::array<Recent, 4>> recent_;
  std::vector<bool> crashed_;
  std::vector<std::uint8_t> is_moved_;  // in this step: there is one in moved_
  std::vector<Meeting> meetings_;
  std::vector<Moved> moved_;
  std::vector<CollisionEvent> events_;
};

}  // namespace cuscus::world
