#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/city/geometry/capsule.h"
#include "common/city/geometry/solid_shape.h"

namespace cuscus::city {

/// Makes `other` the first if it is earlier, or as early and more head-on.
void keep_first(std::optional<Touch>& first, const Touch& other, const Eigen::Vector3d& way);

/// Where a point on its way from p to p + way goes into a capsule, or deeper into it.
[[nodiscard]] std::optional<Touch> sweep_capsule(const Capsule& capsule, const Eigen::Vector3d& p,
                                                 const Eigen::Vector3d& way);

}  // namespace cuscus::city
