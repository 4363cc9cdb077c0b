#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cuscus::world {

struct BallPair {
  std::uint32_t a;  ///< Below b.
  std::uint32_t b;

  friend bool operator==(const BallPair&, const BallPair&) = default;
};

/// The pairs of balls that could meet soon: all whose surfaces were within a margin when last
/// looked at, kept until two balls together may have gone that far.
///
/// Source: L. Verlet, "Computer experiments on classical fluids I", Physical Review 159 (1967),
/// section II (the list of neighbours), with the balls in square cells for making it.
class ClosePairs final {
 public:
  /// Balls of radius 0 are in no pair.
  explicit ClosePairs(std::vector<double> radii_m);

  /// The pairs to look at in a step in which no ball goes further than `most_way_m` from
  /// `centres`: at least all that can meet in it. Ascending.
  [[nodiscard]] std::span<const BallPair> during(std::span<const Eigen::Vector3d> centres,
                                                 double most_way_m);
  /// A contact has moved a ball further than was said, by this much.
  void went_further(double way_m) { gone_m_ += way_m; }

 private:
  struct Place {
    std::int64_t row;
    std::int64_t column;
    std::uint32_t ball;
  };

  void gather(std::span<const Eigen::Vector3d> centres);
  void add_if_close(std::uint32_t a, std::uint32_t b, std::span<const Eigen::Vector3d> centres);

  std::vector<double> radii_m_;
  double most_radius_m_{0.0};
  double margin_m_{0.0};
  double gone_m_{0.0};  // by any ball since the list was made, at most
  bool made_{false};
  std::vector<Place> places_;
  std::vector<BallPair> pairs_;
};

}  // namespace cuscus::world
