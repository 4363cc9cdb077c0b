// The circle mission of ten UAVs on the real plant, in simulated time.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "tests/support/flight_rig.h"

namespace cuscus::tests {
namespace {

/// What a fleet did from `settled_s` until the end of its flight.
struct Outcome {
  double median_error_m = 0.0;
  double worst_error_m = 0.0;
  double worst_radial_m = 0.0;  ///< Off the circle, in the plane and in altitude.
  double converged_s = 0.0;     ///< From then on no error was above 0.5 m.
  double closest_pair_m = std::numeric_limits<double>::infinity();  ///< Over the whole flight.
  double mean_speed_mps = 0.0;
  bool all_flying = true;
};

Outcome flown(const CircleFleet::Settings& settings, double settled_s = 35.0, double end_s = 60.0) {
  CircleFleet fleet{settings};
  Outcome outcome;
  std::vector<double> errors_m;
  std::vector<double> speeds_mps;
  fleet.fly_until(end_s, [&] {
    const double now_s = to_seconds(fleet.rig().now().time_since_epoch());
    const auto now_errors_m = fleet.formation_errors_m();
    if (*std::max_element(now_errors_m.begin(), now_errors_m.end()) > 0.5) {
      outcome.converged_s = now_s;
    }
    outcome.closest_pair_m = std::min(outcome.closest_pair_m, fleet.closest_pair_m());
    if (now_s < settled_s) {
      return;
    }
    errors_m.insert(errors_m.end(), now_errors_m.begin(), now_errors_m.end());
    speeds_mps.push_back(fleet.rig().truth(0).v_WB_W_mps.norm());
    for (const double radial_m : fleet.radial_errors_m()) {
      outcome.worst_radial_m = std::max(outcome.worst_radial_m, radial_m);
    }
  });
  std::sort(errors_m.begin(), errors_m.end());
  outcome.median_error_m = errors_m[errors_m.size() / 2];
  outcome.worst_error_m = errors_m.back();
  outcome.mean_speed_mps = std::accumulate(speeds_mps.begin(), speeds_mps.end(), 0.0) /
                           static_cast<double>(speeds_mps.size());
  for (std::size_t i = 0; i < fleet.rig().size(); ++i) {
    outcome.all_flying &= fleet.rig().pilot(i).state() == flight::FlightState::kFlying;
  }
  return outcome;
}

void check_formation(const Outcome& outcome) {
  CAPTURE(outcome.median_error_m, outcome.worst_error_m, outcome.worst_radial_m,
          outcome.converged_s, outcome.closest_pair_m, outcome.mean_speed_mps);
  CHECK(outcome.all_flying);
  CHECK(outcome.median_error_m < 0.5);
  CHECK(outcome.worst_radial_m < 0.2);
  CHECK(outcome.converged_s < 35.0);
  // Neighbours at rest in their slots are 12.4 m apart; starts are scattered by 1 m in each axis.
  CHECK(outcome.closest_pair_m > 8.0);
}

CircleFleet::Settings with_beacons(int period_ms) {
  CircleFleet::Settings settings;
  settings.beacon_period = std::chrono::milliseconds{period_ms};
  settings.neighbour_timeout = std::chrono::seconds{6};
  return settings;
}

// By 90 s the slowest mode of the ring (10.5 s) has died out. Bounds come from six seeds and not
// from the one flown here; docs/models/circle.md has the table. Beacon periods of 50 and 500 ms
// cannot be told apart by this error, which leaves the common phase out: what a longer period costs
// is speed. So there is no check that orders them.
TEST_CASE("a settled fleet keeps its formation, and stale positions cost it speed") {
  struct Case {
    int period_ms;  ///< 0: motion capture.
    double error_bound_m;
  };
  const Case given = GENERATE(Case{0, 0.02}, Case{50, 0.03}, Case{500, 0.03});
  CircleFleet::Settings settings = with_beacons(given.period_ms);
  if (given.period_ms == 0) {
    settings.beacon_period.reset();
  }

  const Outcome outcome = flown(settings, 90.0, 120.0);

  CAPTURE(given.period_ms);
  check_formation(outcome);
  CHECK(outcome.median_error_m < given.error_bound_m);
  // w = w0 / (1 + gain age). Mean age of a beacon's position: half a period, 1 ms of air, the age
  // of the estimate sent (0 ... 5 ms), the wait for the next control period (0 ... 5 ms); of a
  // motion-capture reading: half of its 10 ms.
  const double age_s = given.period_ms == 0 ? 0.005 : 0.5e-3 * given.period_ms + 0.006;
  const double expected_mps =
      settings.circle.speed_mps / (1.0 + settings.circle.spacing_gain_ps * age_s);
  CHECK(outcome.mean_speed_mps == Approx(expected_mps).epsilon(0.01));
}

TEST_CASE("a beacon period near the time constant of the law widens the formation error") {
  const Outcome outcome = flown(with_beacons(2000), 90.0, 120.0);

  CHECK(outcome.all_flying);
  // Above what any of six seeds had at 50 and 500 ms.
  CHECK(outcome.median_error_m > 0.03);
  CHECK(outcome.median_error_m < 0.5);
}

TEST_CASE("lost beacons widen the formation error") {
  auto lossy = with_beacons(500);
  lossy.beacon_loss = 0.3;

  const Outcome outcome = flown(lossy, 90.0, 120.0);

  CHECK(outcome.all_flying);
  // Without losses it is below 0.05 m, see above.
  CHECK(outcome.median_error_m > 0.1);
  CHECK(outcome.median_error_m < 1.0);
  CHECK(outcome.worst_radial_m < 0.2);
}

TEST_CASE("fleets of 1, 1.5 and 2 kg fly the circle, also when the control laws believe 1.2 kg") {
  CircleFleet::Settings settings = with_beacons(50);
  settings.mass_kg = GENERATE(1.0, 1.5, 2.0);
  const bool believed = GENERATE(true, false);
  if (!believed) {
    settings.nominal_mass_kg = 1.2;
  }

  check_formation(flown(settings));
}

TEST_CASE("a wreck on the ground does not hold up a fleet that flies low") {
  CircleFleet::Settings settings = with_beacons(50);
  settings.fleet_size = 4;
  settings.circle.p_WC_centre_m.z() = 3.0;
  const bool crashed = GENERATE(true, false);
  if (crashed) {
    settings.beacon_period.reset();  // seen lying by motion capture
  }
  CircleFleet fleet{settings};
  fleet.fly_until(30.0);
  REQUIRE(fleet.all_circling());

  if (crashed) {
    fleet.rig().silence_imu(2, true);
  } else {
    fleet.rig().pilot(2).land();  // and beacons from the ground
  }
  fleet.fly_until(60.0);

  REQUIRE(fleet.rig().on_ground(2));
  // Its follower and its predecessor see a neighbour each, and none that stands: they keep the
  // speed of the circle. Held up, the follower would stop before the wreck.
  for (const std::size_t neighbour : {1U, 3U}) {
    CHECK(fleet.rig().truth(neighbour).v_WB_W_mps.norm() ==
          Approx(settings.circle.speed_mps).epsilon(0.05));
  }
}

TEST_CASE("fleets of all sizes fly the circle") {
  CircleFleet::Settings settings = with_beacons(50);
  settings.fleet_size = GENERATE(1U, 2U, 3U);

  const Outcome outcome = flown(settings);

  CHECK(outcome.all_flying);
  CHECK(outcome.worst_error_m < 0.5);
  CHECK(outcome.worst_radial_m < 0.2);
}

}  // namespace
}  // namespace cuscus::tests
