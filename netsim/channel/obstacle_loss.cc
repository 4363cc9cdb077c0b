#include "netsim/channel/obstacle_loss.h"

#include <algorithm>
#include <array>
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
  std::array<double, kWays> around;  ///< p(ν) of its own edge, by Way.
  double share;                      ///< P.
  double in_view;      ///< p₀ + (1 - p₀) U: of power that passes it together with others.
  double beyond{1.0};  ///< Of power that passes those that turn more at B, one by one.
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
  const double level_m = base_m * (1.0 + longer);
  const double bent_m = std::sqrt(level_m * level_m + rise_m * rise_m);
  const double detour_m = base_m * base_m * longer * (2.0 + longer) / (bent_m + link.length_m);
  return knife_edge_share(2.0 * std::sqrt(detour_m / link.wavelength_m));
}

Passage passage_of(const Obstruction& body, const Baseline& link) {
  Passage passage{.body = &body, .around = {}, .share = 0.0, .in_view = 0.0};
  double unseen = 1.0;
  for (std::size_t way = 0; way < kWays; ++way) {
    passage.around[way] = share_by(body.turns[way], static_cast<Way>(way), link);
    unseen *= 1.0 - passage.around[way] / kGrazing;
  }
  unseen = std::max(0.0, unseen);
  const double through = (-(body.outer_loss + body.inner_loss)).ratio();
  passage.share = unseen * through + kGrazing * (1.0 - unseen);
  passage.in_view = kGrazing + (1.0 - kGrazing) * unseen;
  return passage;
}

/// The most that passes on one way by an edge that clears two bodies or more, the rest one by one.
///
/// An edge of Bullington's, by the turns of two of the bodies, clears those that turn no more at
/// either end. So they are gone through in the order of their turns at B, for each turn at A. What
/// passes an edge is no more than what passes the edges of what it clears: mostly that says enough.
double together(std::vector<Passage>& passages, Way way, const Baseline& link, double already) {
  const auto index = static_cast<std::size_t>(way);
  const auto turn_of = [index](const Passage& p) -> const Turn& { return p.body->turns[index]; };
  std::stable_sort(passages.begin(), passages.end(), [&](const Passage& x, const Passage& y) {
    return turn_of(x).at_b < turn_of(y).at_b;
  });
  double beyond = 1.0;
  for (auto p = passages.rbegin(); p != passages.rend(); ++p) {
    p->beyond = beyond;
    beyond *= p->share;
  }
  double most = already;
  for (const Passage& a : passages) {
    const double at_a = turn_of(a).at_a;
    double around = kGrazing;
    double passed = 1.0;
    for (const Passage& b : passages) {
      if (turn_of(b).at_a > at_a) {
        passed *= b.share;
        continue;
      }
      passed *= b.in_view;
      around = std::min(around, b.around[index]);
      if (around * passed * b.beyond > most) {
        const Turn edge{.at_a = at_a, .at_b = turn_of(b).at_b};
        most = std::max(most, share_by(edge, way, link) * passed * b.beyond);
      }
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
