#include "world/collision/close_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace cuscus::world {
namespace {

/// At 10 m/s a new list every tenth of a second.
constexpr double kLeastMargin_m = 2.0;
/// Fast balls have a list for at least so many steps.
constexpr double kStepsOfList = 4.0;

}  // namespace

ClosePairs::ClosePairs(std::vector<double> radii_m) : radii_m_{std::move(radii_m)} {
  for (std::uint32_t i = 0; i < radii_m_.size(); ++i) {
    if (radii_m_[i] > 0.0) {
      most_radius_m_ = std::max(most_radius_m_, radii_m_[i]);
      places_.push_back({.row = 0, .column = 0, .ball = i});
    }
  }
}

std::span<const BallPair> ClosePairs::during(std::span<const Eigen::Vector3d> centres,
                                             double most_way_m) {
  if (places_.size() < 2) {
    return {};
  }
  gone_m_ += most_way_m;
  if (!made_ || 2.0 * gone_m_ > margin_m_) {
    made_ = true;
    gone_m_ = most_way_m;
    margin_m_ = std::max(kLeastMargin_m, 2.0 * kStepsOfList * most_way_m);
    gather(centres);
  }
  return pairs_;
}

void ClosePairs::gather(std::span<const Eigen::Vector3d> centres) {
  const double cell_m = 2.0 * most_radius_m_ + margin_m_;
  for (Place& place : places_) {
    place.row = std::llround(std::floor(centres[place.ball].y() / cell_m));
    place.column = std::llround(std::floor(centres[place.ball].x() / cell_m));
  }
  std::sort(places_.begin(), places_.end(), [](const Place& one, const Place& other) {
    return std::tie(one.row, one.column, one.ball) < std::tie(other.row, other.column, other.ball);
  });
  pairs_.clear();
  // Of every cell: the rest of it, the cell to the east, and the three to the north.
  std::size_t north = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& here = places_[i];
    for (std::size_t k = i + 1;
         k < places_.size() && places_[k].row == here.row && places_[k].column <= here.column + 1;
         ++k) {
      add_if_close(here.ball, places_[k].ball, centres);
    }
    const auto before = [&](const Place& place) {
      return std::pair{place.row, place.column} < std::pair{here.row + 1, here.column - 1};
    };
    while (north < places_.size() && before(places_[north])) {
      ++north;
    }
    for (std::size_t k = north; k < places_.size() && places_[k].row == here.row + 1 &&
                                places_[k].column <= here.column + 1;
         ++k) {
      add_if_close(here.ball, places_[k].ball, centres);
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const BallPair& one, const BallPair& other) {
    return std::tie(one.a, one.b) < std::tie(other.a, other.b);
  });
}

void ClosePairs::add_if_close(std::uint32_t a, std::uint32_t b,
                              std::span<const Eigen::Vector3d> centres) {
  const double reach_m = radii_m_[a] + radii_m_[b] + margin_m_;
  if ((centres[a] - centres[b]).squaredNorm() <= reach_m * reach_m) {
    pairs_.push_back({.a = std::min(a, b), .b = std::max(a, b)});
  }
}

}  // namespace cuscus::world
