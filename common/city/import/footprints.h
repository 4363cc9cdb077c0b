#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "common/city/city.h"

/// Polygons of buildings, and what of one is left beside another. Overlays by Boost.Polygon.
namespace cuscus::city {

/// Positive for counter-clockwise rings [m^2].
[[nodiscard]] double signed_area_m2(const Ring& ring);
/// Without its courtyards [m^2].
[[nodiscard]] double area_m2(const Footprint& footprint);
/// Twice the area over the perimeter: the width of something long [m].
[[nodiscard]] double mean_width_m(const Footprint& footprint);
[[nodiscard]] Eigen::AlignedBox2d bounds_of(const Footprint& footprint);
/// True when every corner of `inner` is within `outer` or on its outline, which is enough for
/// buildings.
[[nodiscard]] bool holds_corners(const Footprint& outer, const Footprint& inner);
/// Footprints that share less only touch: noise of their corners' last digits [m^2].
inline constexpr double kTouching_m2 = 1e-3;
/// Of both at once [m^2], on corners rounded to 0.1 mm.
[[nodiscard]] double overlap_m2(const Footprint& one, const Footprint& other);

/// Rings as City wants them: open, no corner twice in a row, the outer one counter-clockwise.
/// None: the outer ring has less than three corners or no area. Courtyards without area vanish.
[[nodiscard]] std::optional<Footprint> normalized(Footprint footprint);

/// What is left of `whole` beside all of `others`, corners rounded to 0.1 mm. Pieces thinner than
/// `thinnest_m` on average are dropped; what the others do not share more than kTouching_m2 with
/// comes back as it was.
[[nodiscard]] std::vector<Footprint> subtract(const Footprint& whole,
                                              std::span<const Footprint* const> others,
                                              double thinnest_m);

/// What of the footprint lies in an upright box.
[[nodiscard]] std::vector<Footprint> clip(const Footprint& footprint,
                                          const Eigen::AlignedBox2d& box);

/// What of a line lies in an upright box.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> clip_line(
    const std::vector<Eigen::Vector2d>& line, const Eigen::AlignedBox2d& box);

}  // namespace cuscus::city
