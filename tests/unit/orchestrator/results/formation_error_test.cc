#include "orchestrator/results/formation_error.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace cuscus::orchestrator {
namespace {

const FormationCircle kCircle{.p_WC_m = {100.0, -50.0, 15.0}, .radius_m = 20.0};

Eigen::Vector3d on_circle(double angle_rad, double radius_m = kCircle.radius_m) {
  return kCircle.p_WC_m +
         Eigen::Vector3d{radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0.0};
}

std::vector<FormationMember> ring(std::uint32_t n, double phase_rad) {
  std::vector<FormationMember> members;
  for (std::uint32_t i = 0; i < n; ++i) {
    members.push_back({.p_WB_m = on_circle(phase_rad + 2.0 * std::numbers::pi * i / n), .slot = i});
  }
  return members;
}

// Rounding of coordinates of 100 m.
constexpr double kRounding_m = 1e-11;

TEST_CASE("a ring has no error, wherever it has turned to and in whatever order it is told") {
  const double phase_rad = GENERATE(0.0, 0.3, 2.0, -3.0, 3.14159);
  const std::uint32_t n = GENERATE(1U, 2U, 3U, 10U);
  CAPTURE(phase_rad, n);
  auto members = ring(n, phase_rad);
  std::reverse(members.begin(), members.end());

  const FormationError error = formation_error(kCircle, members);

  CHECK(error.phase_rad == Approx(phase_rad).margin(1e-12));
  CHECK(error.error_m.size() == n);
  CHECK(error.max_m < kRounding_m);
  CHECK(error.rms_m < kRounding_m);
}

TEST_CASE("one UAV displaced along its radius errs by that much, the others not at all") {
  auto members = ring(10, 0.7);
  members[4].p_WB_m = on_circle(0.7 + 2.0 * std::numbers::pi * 4 / 10, 20.0 + 3.0);

  const FormationError error = formation_error(kCircle, members);

  CHECK(error.error_m[4] == Approx(3.0));
  CHECK(error.error_m[3] < kRounding_m);
  CHECK(error.max_m == Approx(3.0));
  CHECK(error.mean_m == Approx(0.3));
  CHECK(error.rms_m == Approx(3.0 / std::sqrt(10.0)));
}

TEST_CASE("one UAV ahead along the circle pulls the phase of all after it") {
  // arg(n - 1 + exp(j d)) = atan2(sin d, n - 1 + cos d); a chord subtends 2 R sin(angle / 2).
  const double ahead_rad = 0.5;
  auto members = ring(4, 0.0);
  members[0].p_WB_m = on_circle(ahead_rad);

  const FormationError error = formation_error(kCircle, members);

  const double phase_rad = std::atan2(std::sin(ahead_rad), 3.0 + std::cos(ahead_rad));
  CHECK(error.phase_rad == Approx(phase_rad));
  CHECK(error.error_m[1] == Approx(2.0 * 20.0 * std::sin(phase_rad / 2.0)));
  CHECK(error.error_m[0] == Approx(2.0 * 20.0 * std::sin((ahead_rad - phase_rad) / 2.0)));
}

TEST_CASE("a fleet at the wrong height errs by the difference") {
  auto members = ring(6, 1.0);
  for (auto& member : members) {
    member.p_WB_m.z() -= 2.5;
  }

  CHECK(formation_error(kCircle, members).mean_m == Approx(2.5));
}

TEST_CASE("phases on both sides of the half turn average across it, not through zero") {
  const double pi = std::numbers::pi;
  const std::vector<FormationMember> members{{.p_WB_m = on_circle(pi - 0.1), .slot = 0},
                                             {.p_WB_m = on_circle(pi + pi + 0.1), .slot = 1}};

  const FormationError error = formation_error(kCircle, members);

  CHECK(std::abs(error.phase_rad) == Approx(pi));
  CHECK(error.error_m[0] == Approx(2.0 * 20.0 * std::sin(0.05)));
  CHECK(error.error_m[1] == Approx(error.error_m[0]));
}

TEST_CASE("UAVs in each other's slots are not in formation") {
  auto members = ring(4, 0.0);
  std::swap(members[0].slot, members[2].slot);

  // Their phases are turned by half a turn each and cancel the two that are right: no phase is
  // better than 0, at which two UAVs are a diameter away.
  const FormationError error = formation_error(kCircle, members);

  CHECK(error.phase_rad == 0.0);
  CHECK(error.max_m == Approx(40.0));
  CHECK(error.mean_m == Approx(20.0));
}

TEST_CASE("a UAV at the centre errs by the radius and does not turn the ring") {
  auto members = ring(5, 0.4);
  members[2].p_WB_m = kCircle.p_WC_m;

  const FormationError error = formation_error(kCircle, members);

  CHECK(error.phase_rad == Approx(0.4));
  CHECK(error.error_m[2] == Approx(20.0));
}

TEST_CASE("a fleet that is no formation is refused") {
  CHECK_THROWS_AS(formation_error(kCircle, {}), std::invalid_argument);
  auto members = ring(3, 0.0);
  CHECK_THROWS_AS(formation_error({.p_WC_m = {0.0, 0.0, 0.0}, .radius_m = 0.0}, members),
                  std::invalid_argument);
  members[1].slot = 3;
  CHECK_THROWS_AS(formation_error(kCircle, members), std::invalid_argument);
  members[1].slot = 2;
  CHECK_THROWS_AS(formation_error(kCircle, members), std::invalid_argument);
}

}  // namespace
}  // namespace cuscus::orchestrator
