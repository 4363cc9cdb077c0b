#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/units/sim_time.h"
#include "proto/report.pb.h"
#include "world/collision/collisions.h"
#include "world/dynamics/plant.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

/// Lets the vehicles of a run's plants touch the world and one another, and keeps count.
class FleetCollisions {
 public:
  struct Member {
    std::uint32_t node;
    std::string name;
    Plant* plant;       ///< Without a ground of its own; holds where the vehicle starts.
    std::size_t index;  ///< In the plant.
    CollisionBody body;
  };

  /// Vehicles that start on something stand on it; one on a slope as much higher as its ball needs.
  /// `buildings`, which must outlive this, says what each is called; else by their numbers.
  /// @throws std::invalid_argument naming the vehicle, its place and what is there, when one would
  /// start in something.
  FleetCollisions(std::vector<Member> members, const Surroundings& surroundings,
                  std::span<const std::string> buildings = {});

  /// After a step of the plants: takes the vehicles where contacts allow them to be, and stops the
  /// motors of those that crash.
  void step(SimTime now);

  /// Where vehicle number `member` is.
  [[nodiscard]] const RigidBodyState& state(std::size_t member) const { return states_[member]; }
  [[nodiscard]] bool has_crashed(std::size_t member) const { return tallies_[member].crashed; }

  /// The first contact of a vehicle in the run.
  struct FirstContact {
    std::string name;
    std::string what;  ///< "building 12 (way 4711)", "the ground", "uav3"
    Eigen::Vector3d p_WB_m;
    double speed_mps;
    bool crash;
  };
  /// Those of the latest step.
  [[nodiscard]] std::span<const FirstContact> first_contacts() const { return first_contacts_; }

  /// Adds an entry for every vehicle that has touched something.
  void report(proto::WorldReport& report) const;

 private:
  struct Tally {
    std::uint64_t buildings{0};
    std::uint64_t ground{0};
    std::uint64_t trees{0};
    std::uint64_t vehicles{0};
    bool crashed{false};

    [[nodiscard]] std::uint64_t contacts() const { return buildings + ground + trees + vehicles; }
  };

  void rise_from_slope(std::size_t member);
  void check_start(std::size_t member) const;
  void count(const CollisionEvent& event);
  [[nodiscard]] std::string name_of(const Struck& struck) const;
  [[nodiscard]] std::string name_of(city::Body body, std::uint32_t index) const;

  std::vector<Member> members_;
  bool has_city_;
  std::span<const std::string> buildings_;
  std::vector<RigidBodyState> states_;
  std::vector<Tally> tallies_;
  std::vector<FirstContact> first_contacts_;
  Collisions collisions_;
};

}  // namespace cuscus::world
