#include "netsim/channel/obstacle_loss.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace cuscus::netsim {
namespace {

/// A link as the ways past a body see it.
struct Baseline {
  double length_m;
  double level_m;  ///< Seen from above.
  double rise_m;
  double wavelength_m;
};

/// A body that is crossed, as a share of the power.
struct Passage {
  const Obstruction* body;
  double share;    ///< P.
  double in_view;  ///< p₀ + (1 - p₀) U: of power that passes it together with others.
};

const double kGrazing = knife_edge_share(0.0);

/// p(ν) of the edge at which the rays from both ends meet that turn by `turn`.
///
/// With a and b the tangents of half the angles, the two sides of such a triangle are together
/// (1 + a b) / (1 - a b) times its base. Around a side that is so seen from above, while the path
/// climbs evenly from end to end.
double share_by(const Turn& turn, Way way, const Baseline& link) {
  const double product = turn.at_a * turn.at_b;
  if (!(product < 1.0)) {
    return 0.0;  // the rays do not meet
  }
  const double longer = 2.0 * product / (1.0 - product);
  const double base_m = way == Way::kOver ? link.length_m : link.level_m;
  const double rise_m = way == Way::kOver ? 0.0 : link.rise_m;
  const double bent_m = std::hypot(base_m * (1.0 + longer), rise_m);
  const double detour_m = base_m * base_m * longer * (2.0 + longer) / (bent_m + link.length_m);
  return knife_edge_share(2.0 * std::sqrt(detour_m / link.wavelength_m));
}

Passage passage_of(const Obstruction& body, const Baseline& link) {
  double unseen = 1.0;
  for (std::size_t way = 0; way < kWays; ++way) {
    unseen *= 1.0 - share_by(body.turns[way], static_cast<Way>(way), link) / kGrazing;
  }
  unseen = std::max(0.0, unseen);
  const double through = (-(body.outer_loss + body.inner_loss)).ratio();
  return {.body = &body,
          .share = unseen * through + kGrazing * (1.0 - unseen),
          .in_view = kGrazing + (1.0 - kGrazing) * unseen};
}

/// The most that passes on one way by an edge that clears two bodies or more, the rest one by one.
double together(const std::vector<Passage>& passages, Way way, const Baseline& link,
                double already) {
  const auto turn_of = [way](const Passage& p) {
    return p.body->turns[static_cast<std::size_t>(way)];
  };
  double most = already;
  for (const Passage& a : passages) {
    for (const Passage& b : passages) {
      const Turn turn{.at_a = turn_of(a).at_a, .at_b = turn_of(b).at_b};
      double share = share_by(turn, way, link);
      for (const Passage& p : passages) {
        if (share <= most) {
          break;
        }
        const Turn own = turn_of(p);
        share *= own.at_a <= turn.at_a && own.at_b <= turn.at_b ? p.in_view : p.share;
      }
      most = std::max(most, share);
    }
  }
  return most;
}

}  // namespace

double knife_edge_share(double fresnel_parameter) {
  const double x = fresnel_parameter - 0.1;
  const double amplitude = std::sqrt(x * x + 1.0) + x;
  static const double kScale = std::pow(10.0, -0.69);
  return std::min(1.0, kScale / (amplitude * amplitude));
}

double clear_zone_m(double wavelength_m) {
  constexpr double kClear = 0.79;  // |ν|: the formula's share is 1 from 0.78 on
  return wavelength_m * kClear * kClear / 4.0;
}

ObstacleTerms obstacle_terms(std::span<const Obstruction> found, const Eigen::Vector3d& p_WA,
                             const Eigen::Vector3d& p_WB, double wavelength_m) {
  ObstacleTerms terms;
  if (found.empty()) {
    return terms;
  }
  const Eigen::Vector3d way_m = p_WB - p_WA;
  const Baseline link{.length_m = way_m.norm(),
                      .level_m = way_m.head<2>().norm(),
                      .rise_m = way_m.z(),
                      .wavelength_m = wavelength_m};
  double grazed = 1.0;
  double one_by_one = 1.0;
  std::vector<Passage> passages;
  for (const Obstruction& body : found) {
    if (!body.crossed) {
      grazed *= knife_edge_share(-2.0 * std::sqrt(body.clearance_m / wavelength_m));
      continue;
    }
    terms.walls.outer += body.walls.outer;
    terms.walls.inner += body.walls.inner;
    terms.outer_walls = terms.outer_walls + body.outer_loss;
    terms.inner_walls = terms.inner_walls + body.inner_loss;
    passages.push_back(passage_of(body, link));
    one_by_one *= passages.back().share;
  }
  double share = one_by_one;
  if (passages.size() > 1) {
    for (std::size_t way = 0; way < kWays; ++way) {
      share = together(passages, static_cast<Way>(way), link, share);
    }
  }
  const Decibel loss = -Decibel::from_ratio(grazed * share);
  terms.diffraction = loss - (terms.outer_walls + terms.inner_walls);
  return terms;
}

}  // namespace cuscus::netsim
