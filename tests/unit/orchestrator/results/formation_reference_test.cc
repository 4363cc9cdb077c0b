#include "orchestrator/results/formation_reference.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace cuscus::orchestrator {
namespace {

constexpr int kFleet = 10;
const FormationCircle kRaisedCircle{.p_WC_m = {5.0, -3.0, 10.0}, .radius_m = 20.0};
constexpr double kSpeed_mps = 2.0;

SimTime at_s(double seconds) { return sim_time(static_cast<std::int64_t>(seconds * 1e9)); }

std::vector<FormationMember> ring(double phase_rad, double height_m = 10.0) {
  std::vector<FormationMember> members;
  for (std::uint32_t slot = 0; slot < kFleet; ++slot) {
    const double angle_rad = phase_rad + 2.0 * std::numbers::pi * slot / kFleet;
    members.push_back(
        {.p_WB_m = {5.0 + 20.0 * std::cos(angle_rad), -3.0 + 20.0 * std::sin(angle_rad), height_m},
         .slot = slot});
  }
  return members;
}

/// Feeds a ring that turns at `speed_mps` from 0 s to `end_s`; returns slot 3's last error.
double fly(FormationReference& reference, double speed_mps, double end_s) {
  double error_m = 0.0;
  for (double t = 0.0; t <= end_s; t += 0.1) {
    error_m = reference.errors_m(at_s(t), ring(0.3 + speed_mps / 20.0 * t)).at(3);
  }
  return error_m;
}

TEST_CASE("a fleet that turns at the mission's speed has no error") {
  FormationReference reference{kRaisedCircle, kSpeed_mps};

  CHECK(fly(reference, kSpeed_mps, 60.0) == Approx(0.0).margin(1e-6));
  REQUIRE(reference.formed_at());
}

TEST_CASE("a fleet that keeps its shape but turns too slowly lags behind its vertices") {
  FormationReference reference{kRaisedCircle, kSpeed_mps};

  const double error_m = fly(reference, 1.9, 60.0);

  // Since it was fixed, the phase has fallen back by 0.1 m/s / 20 m: a chord of the circle.
  const double last_s = 600 * 0.1;
  const double lag_rad =
      0.1 / 20.0 * (last_s - to_seconds(reference.formed_at().value().time_since_epoch()));
  CHECK(error_m == Approx(2.0 * 20.0 * std::sin(lag_rad / 2.0)).margin(0.01));
}

TEST_CASE("before the fleet has formed, any phase will do, and its height counts") {
  FormationReference reference{kRaisedCircle, kSpeed_mps};

  for (const double phase_rad : {0.0, 1.0, -2.0}) {
    for (const double error_m : reference.errors_m(at_s(1.0), ring(phase_rad, 4.0))) {
      CHECK(error_m == Approx(6.0));
    }
  }
  CHECK_FALSE(reference.formed_at());
}

TEST_CASE("a shape that is lost before it has held long enough does not fix the phase") {
  FormationReference reference{kRaisedCircle, kSpeed_mps};

  static_cast<void>(reference.errors_m(at_s(0.0), ring(0.0)));
  static_cast<void>(reference.errors_m(at_s(4.0), ring(0.0, 2.0)));
  static_cast<void>(reference.errors_m(at_s(6.0), ring(0.0)));

  CHECK_FALSE(reference.formed_at());
  static_cast<void>(reference.errors_m(at_s(11.0), ring(0.5)));
  CHECK(reference.formed_at() == at_s(11.0));
}

}  // namespace
}  // namespace cuscus::orchestrator
