#include "world/sensors/gnss.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/unit/world/blocks.h"
#include "world/sensors/position_solution.h"

namespace cuscus::world {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr city::Geodetic kSite{.latitude_deg = 49.4, .longitude_deg = 2.8, .height_m = 40.0};
const Constellation kSky{
    kSite, std::chrono::sys_seconds{std::chrono::sys_days{std::chrono::year{2026} / 1 / 1}}};
constexpr std::int64_t kTenMinutes_ns = 600'000'000'000;
constexpr int kDay = 144;  // of ten minutes

/// Where satellites above `mask_rad` are that `is_free` lets through.
template <typename Free>
std::vector<Eigen::Vector3d> received_of(SimTime time, double mask_rad, const Free& is_free) {
  std::vector<Eigen::Vector3d> received;
  for (const Eigen::Vector3d& direction : kSky.directions(time)) {
    if (direction.z() >= std::sin(mask_rad) && is_free(direction)) {
      received.push_back(direction);
    }
  }
  return received;
}

/// A street 30 m wide from south to north, between walls 15 m high from -5 to 5 km.
const city::CityGeometry& canyon() {
  static const city::CityGeometry geometry{
      city_of({{.low_m = {-35.0, -5000.0, 0.0}, .high_m = {-15.0, 5000.0, 15.0}},
               {.low_m = {15.0, -5000.0, 0.0}, .high_m = {35.0, 5000.0, 15.0}}})};
  return geometry;
}

/// Whether a ray from (x, 0, z) in the street gets out of it: over a wall, or past its end.
bool leaves_canyon(double x_m, double z_m, const Eigen::Vector3d& direction) {
  const double across_m = direction.x() > 0.0 ? 15.0 - x_m : 15.0 + x_m;
  const double way_m = across_m / std::abs(direction.x());
  return z_m + way_m * direction.z() > 15.0 || std::abs(way_m * direction.y()) > 5000.0;
}

TEST_CASE("which satellites a street hides follows from the angles over its walls") {
  const double x_m = GENERATE(0.0, -9.0, 6.5);
  const Surroundings street{&canyon()};
  Gnss gnss{1, 0, {}, kSky};
  int hidden = 0;
  int without_fix = 0;

  for (int i = 0; i < kDay; ++i) {
    const SimTime time = sim_time(i * kTenMinutes_ns);
    const auto sample =
        gnss.sample(street, {.p_WB_m = {x_m, 0.0, 1.5}}, time, static_cast<std::uint64_t>(i));
    const auto in_view =
        received_of(time, 5.0 * kDegree, [](const Eigen::Vector3d&) { return true; });
    // The antenna is 10 cm above the vehicle.
    const auto expected = received_of(time, 5.0 * kDegree, [&](const Eigen::Vector3d& direction) {
      return leaves_canyon(x_m, 1.6, direction);
    });
    const auto solution = PositionSolution::of(expected);

    CAPTURE(i);
    CHECK(sample.in_view == in_view.size());
    CHECK(sample.received == expected.size());
    REQUIRE(sample.fix.has_value() == solution.has_value());
    if (solution) {
      CHECK(sample.fix->hdop == Approx(solution->hdop()));
      CHECK(sample.fix->vdop == Approx(solution->vdop()));
    }
    hidden += static_cast<int>(in_view.size() - expected.size());
    without_fix += solution ? 0 : 1;
  }

  CHECK(hidden > kDay);
  CHECK(without_fix > 0);
  CHECK(without_fix < kDay);
}

TEST_CASE("in the open all satellites above the mask make the fix, and one below it none") {
  const double mask_deg = GENERATE(0.0, 10.0, 40.0);
  Gnss gnss{1, 0, {.mask_rad = mask_deg * kDegree}, kSky};

  for (int i = 0; i < kDay; ++i) {
    const SimTime time = sim_time(i * kTenMinutes_ns);
    const auto expected =
        received_of(time, mask_deg * kDegree, [](const Eigen::Vector3d&) { return true; });

    const auto sample = gnss.sample(Surroundings{}, {}, time, static_cast<std::uint64_t>(i));

    CHECK(sample.in_view == expected.size());
    CHECK(sample.received == expected.size());
    CHECK(sample.fix.has_value() == PositionSolution::of(expected).has_value());
  }
}

TEST_CASE("a roof hides all satellites, and so does lying on one's back") {
  const city::CityGeometry bridge{
      city_of({{.low_m = {-500.0, -500.0, 8.0}, .high_m = {500.0, 500.0, 9.0}}})};
  Gnss under{1, 0, {}, kSky};
  Gnss over{1, 0, {}, kSky};
  Gnss on_its_back{1, 0, {}, kSky};
  RigidBodyState fallen;
  fallen.q_WB = Eigen::AngleAxisd{std::numbers::pi, Eigen::Vector3d::UnitX()};

  const auto hidden = under.sample(Surroundings{&bridge}, {.p_WB_m = {0.0, 0.0, 2.0}}, {}, 0);

  CHECK(hidden.in_view >= 5);
  CHECK(hidden.received == 0);
  CHECK_FALSE(hidden.fix);
  CHECK(over.sample(Surroundings{&bridge}, {.p_WB_m = {0.0, 0.0, 20.0}}, {}, 0).fix);
  CHECK(on_its_back.sample(Surroundings{}, fallen, {}, 0).received == 0);
}

TEST_CASE("a hill hides the satellites behind it") {
  city::City city;
  // Up by 1 m per metre from x = 100 m on, 1000 m far.
  city.terrain = city::Terrain{
      .south_west_m = {-1000.0, -1e5}, .cell_m = 1100.0, .columns = 3, .rows = 183, .height_m = {}};
  for (std::size_t row = 0; row < 183; ++row) {
    city.terrain->height_m.insert(city.terrain->height_m.end(), {0.0F, 0.0F, 1100.0F});
  }
  const city::CityGeometry geometry{city};
  Gnss gnss{1, 0, {}, kSky};

  for (int i = 0; i < kDay; i += 5) {
    const SimTime time = sim_time(i * kTenMinutes_ns);
    // At the foot of the slope, whose crest is 1100 m off and 1100 m high.
    const auto expected = received_of(time, 5.0 * kDegree, [](const Eigen::Vector3d& direction) {
      return direction.z() > direction.x();
    });
    const auto sample = gnss.sample(Surroundings{&geometry}, {.p_WB_m = {100.0, 0.0, 0.0}}, time,
                                    static_cast<std::uint64_t>(i));
    CHECK(sample.received == expected.size());
    CHECK(sample.in_view > sample.received);
  }
}

TEST_CASE("leaves take what ITU-R P.833 says, and too much of a low satellite's signal") {
  // Between 0.949 GHz (0.17 dB/m, 26.5 dB) and 1.852 GHz (0.30 dB/m, 29.0 dB).
  const double share = (1.57542 - 0.949) / (1.852 - 0.949);
  const double specific_dbpm = std::lerp(0.17, 0.30, share);
  const double greatest_db = std::lerp(26.5, 29.0, share);
  for (const double length_m : {0.0, 3.0, 30.0, 300.0}) {
    // Constants are rounded to two and three digits.
    CHECK(foliage_attenuation_db(length_m) ==
          Approx(greatest_db * (1.0 - std::exp(-length_m * specific_dbpm / greatest_db)))
              .epsilon(0.005));
  }
  city::City city;
  city.woods.push_back({.footprint = {.outer = {{-1e4, -1e4}, {1e4, -1e4}, {1e4, 1e4}, {-1e4, 1e4}},
                                      .courtyards = {}},
                        .bottom_m = 0.0,
                        .top_m = 30.1});
  const city::CityGeometry wood{city};
  // 20 dB after 28.2 / 0.26 ln(28.2 / 8.2) m; 30 m of wood are above the antenna.
  const double lowest_rad = std::asin(30.0 / (28.2 / 0.26 * std::log(28.2 / 8.2)));
  Gnss gnss{1, 0, {}, kSky};
  std::size_t lost = 0;

  for (int i = 0; i < kDay; ++i) {
    const SimTime time = sim_time(i * kTenMinutes_ns);
    const auto expected =
        received_of(time, lowest_rad, [](const Eigen::Vector3d&) { return true; });
    const auto sample = gnss.sample(Surroundings{&wood}, {}, time, static_cast<std::uint64_t>(i));
    CHECK(sample.received == expected.size());
    lost += sample.in_view - sample.received;
  }
  CHECK(lost > 100);
}

/// Sums of what a receiver errs that stands still under a sky that does.
struct Errors {
  Eigen::Vector3d squares_m2{Eigen::Vector3d::Zero()};
  Eigen::Vector3d rate_squares{Eigen::Vector3d::Zero()};
  double up_products_m2{0.0};  // of one reading and the next
  GnssFix fix{};
};

constexpr int kReadings = 20'000;

Errors errors_of(const GnssParameters& parameters) {
  Gnss gnss{7, 3, parameters, kSky};
  const RigidBodyState truth{.p_WB_m = {100.0, -50.0, 20.0}, .v_WB_W_mps = {1.0, 2.0, 3.0}};
  Errors errors;
  double up_before_m = 0.0;
  for (std::uint64_t k = 0; k < kReadings; ++k) {
    errors.fix = gnss.sample(Surroundings{}, truth, {}, k).fix.value();
    const Eigen::Vector3d error_m = errors.fix.p_WB_m - truth.p_WB_m;
    const Eigen::Vector3d rate_error_mps = errors.fix.v_WB_W_mps - truth.v_WB_W_mps;
    errors.squares_m2 += error_m.cwiseAbs2();
    errors.rate_squares += rate_error_mps.cwiseAbs2();
    errors.up_products_m2 += up_before_m * error_m.z();
    up_before_m = error_m.z();
  }
  return errors;
}

TEST_CASE("position and velocity err by the ranges' deviation times the dilution of precision") {
  // Range errors of sqrt(3² + 4²) m, independent from reading to reading.
  const Errors errors = errors_of({.period = std::chrono::seconds{20},
                                   .drift_m = 3.0,
                                   .correlation_time = std::chrono::seconds{1},
                                   .noise_m = 4.0,
                                   .rate_noise_mps = 0.2});

  // A deviation of n readings errs by 1 / sqrt(2 n); five times that.
  const double tolerance = 5.0 / std::sqrt(2.0 * kReadings);
  const Eigen::Vector3d& squares_m2 = errors.squares_m2;
  const Eigen::Vector3d& rates = errors.rate_squares;
  CHECK(std::sqrt((squares_m2.x() + squares_m2.y()) / kReadings) ==
        Approx(5.0 * errors.fix.hdop).epsilon(tolerance));
  CHECK(std::sqrt(squares_m2.z() / kReadings) == Approx(5.0 * errors.fix.vdop).epsilon(tolerance));
  CHECK(std::sqrt((rates.x() + rates.y()) / kReadings) ==
        Approx(0.2 * errors.fix.hdop).epsilon(tolerance));
  CHECK(std::sqrt(rates.z() / kReadings) == Approx(0.2 * errors.fix.vdop).epsilon(tolerance));
}

TEST_CASE("slow errors keep their deviation, and forget with their correlation time") {
  const Errors errors = errors_of({.period = std::chrono::seconds{1},
                                   .drift_m = 2.0,
                                   .correlation_time = std::chrono::seconds{10},
                                   .noise_m = 0.0});

  // Squares are correlated by exp(-2 k / 10): n / sum = n (1 - φ²) / (1 + φ²) independent ones.
  const double persistence = std::exp(-0.1);
  const double independent =
      kReadings * (1.0 - persistence * persistence) / (1.0 + persistence * persistence);
  CHECK(std::sqrt(errors.squares_m2.z() / kReadings) ==
        Approx(2.0 * errors.fix.vdop).epsilon(5.0 / std::sqrt(2.0 * independent)));
  // Bartlett: the first correlation of such a process errs by sqrt((1 - φ²) / n).
  CHECK(errors.up_products_m2 / errors.squares_m2.z() ==
        Approx(persistence).margin(5.0 * std::sqrt((1.0 - persistence * persistence) / kReadings)));
}

TEST_CASE("a fix jumps when a street takes satellites away, and not by its slow errors") {
  const GnssParameters parameters{
      .drift_m = 5.0, .correlation_time = std::chrono::hours{1}, .noise_m = 0.0};
  Gnss gnss{5, 0, parameters, kSky};
  const Surroundings street{&canyon()};
  // The first time of the day at which the street leaves a fix.
  const auto time = [] {
    for (int i = 0; i < kDay; ++i) {
      const SimTime at = sim_time(i * kTenMinutes_ns);
      const auto left = received_of(at, 5.0 * kDegree, [](const Eigen::Vector3d& direction) {
        return leaves_canyon(0.0, 1.6, direction);
      });
      if (PositionSolution::of(left)) {
        return at;
      }
    }
    throw std::logic_error{"no fix in this street all day"};
  }();

  const auto above = [&](std::uint64_t reading) -> Eigen::Vector3d {
    return gnss.sample(street, {.p_WB_m = {0.0, 0.0, 60.0}}, time, reading).fix->p_WB_m;
  };
  const Eigen::Vector3d first = above(0);
  const Eigen::Vector3d second = above(1);
  const Eigen::Vector3d within =
      gnss.sample(street, {.p_WB_m = {0.0, 0.0, 1.5}}, time, 2).fix->p_WB_m +
      Eigen::Vector3d{0.0, 0.0, 58.5};

  // In 0.2 s of 1 h a range's error moves by 5 m sqrt(2 0.2 / 3600) = 5 cm.
  CHECK((second - first).norm() < 0.5);
  CHECK((within - second).norm() > 2.0);
}

TEST_CASE("readings are those of their seed and node") {
  const auto fix_of = [](std::uint64_t seed, std::uint32_t node) {
    Gnss gnss{seed, node, {}, kSky};
    static_cast<void>(gnss.sample(Surroundings{}, {}, {}, 0));
    return gnss.sample(Surroundings{}, {}, {}, 1).fix.value();
  };

  CHECK(fix_of(1, 0).p_WB_m == fix_of(1, 0).p_WB_m);
  CHECK(fix_of(1, 0).v_WB_W_mps == fix_of(1, 0).v_WB_W_mps);
  CHECK(fix_of(1, 0).p_WB_m != fix_of(2, 0).p_WB_m);
  CHECK(fix_of(1, 0).p_WB_m != fix_of(1, 1).p_WB_m);
  CHECK(fix_of(1, 0).hdop == fix_of(2, 1).hdop);
}

}  // namespace
}  // namespace cuscus::world
