#include "world/sensors/position_solution.h"

#include <Eigen/Cholesky>

namespace cuscus::world {
namespace {

Eigen::Vector4d row_of(const Eigen::Vector3d& direction) {
  return {-direction.x(), -direction.y(), -direction.z(), 1.0};
}

}  // namespace

std::optional<PositionSolution> PositionSolution::of(std::span<const Eigen::Vector3d> directions) {
  if (directions.size() < 4) {
    return std::nullopt;
  }
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  for (const Eigen::Vector3d& direction : directions) {
    const Eigen::Vector4d row = row_of(direction);
    normal += row * row.transpose();
  }
  const Eigen::LLT<Eigen::Matrix4d> factors{normal};
  if (factors.info() != Eigen::Success) {
    return std::nullopt;
  }
  const PositionSolution solution{factors.solve(Eigen::Matrix4d::Identity())};
  // Written so that what is not a number is refused as well.
  if (!(solution.pdop() <= kGreatestPdop)) {
    return std::nullopt;
  }
  return solution;
}

Eigen::Vector3d PositionSolution::error(std::span<const Eigen::Vector3d> directions,
                                        std::span<const double> range_errors) const {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < directions.size(); ++k) {
    sum += range_errors[k] * row_of(directions[k]);
  }
  return (cofactors_ * sum).head<3>();
}

}  // namespace cuscus::world
