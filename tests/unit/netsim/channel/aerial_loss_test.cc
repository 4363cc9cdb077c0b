#include "netsim/channel/aerial_loss.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "netsim/channel/channel.h"
#include "netsim/channel/street_canyon.h"

namespace cuscus::netsim {
namespace {

constexpr double kCarrier_hz = 2.0e9;

/// A base station at 10 m and an antenna above ground at `height_m`, so far away on the map.
LinkGeometry over_ground(double horizontal_m, double height_m, double base_m = 10.0) {
  return {
      .p_WT = {0.0, 0.0, base_m}, .p_WR = {horizontal_m, 0.0, height_m}, .carrier_hz = kCarrier_hz};
}

LinkGeometry at_elevation(double degrees) {
  const double radians = degrees * std::numbers::pi / 180.0;
  return over_ground(1000.0 * std::cos(radians), 10.0 + 1000.0 * std::sin(radians));
}

TEST_CASE("line of sight over a built-up area is as likely as the sigmoid has it") {
  // Computed independently; to the digits given.
  const AlHourani urban{"urban"};
  CHECK(urban.line_of_sight_probability(at_elevation(10.0)) == Approx(0.100).margin(0.0005));
  CHECK(urban.line_of_sight_probability(at_elevation(30.0)) == Approx(0.731).margin(0.0005));
  CHECK(urban.line_of_sight_probability(at_elevation(45.0)) == Approx(0.968).margin(0.0005));
  CHECK(AlHourani{"suburban"}.line_of_sight_probability(at_elevation(10.0)) ==
        Approx(0.649).margin(0.0005));
  // The same from above and from below.
  LinkGeometry down = at_elevation(30.0);
  std::swap(down.p_WT, down.p_WR);
  CHECK(urban.line_of_sight_probability(down) ==
        urban.line_of_sight_probability(at_elevation(30.0)));
}

TEST_CASE("the losses over a built-up area are free space and its excess") {
  // 1 km at 2 GHz: 20 lg(4 pi 1000 / 0.149896) = 98.469 dB.
  const LinkGeometry link = at_elevation(40.0);
  const auto [environment, seen_db, obstructed_db] =
      GENERATE(table<const char*, double, double>({{"suburban", 0.1, 21.0},
                                                   {"urban", 1.0, 20.0},
                                                   {"dense-urban", 1.6, 23.0},
                                                   {"high-rise", 2.3, 34.0}}));
  CHECK(AlHourani{environment}.loss(link, true).value == Approx(98.469 + seen_db).margin(0.001));
  CHECK(AlHourani{environment}.loss(link, false).value ==
        Approx(98.469 + obstructed_db).margin(0.001));
}

TEST_CASE("3GPP's line of sight is as likely as its tables have it") {
  // UMa-AV and UMi-AV at 40 m and 300 m on the map: computed independently, to the digits given.
  CHECK(Tr36777{"UMa-AV"}.line_of_sight_probability(over_ground(300.0, 40.0)) ==
        Approx(0.919).margin(0.0005));
  CHECK(Tr36777{"UMi-AV"}.line_of_sight_probability(over_ground(300.0, 40.0)) ==
        Approx(0.518).margin(0.0005));
  // By hand: RMa-AV at 20 m: lg = 1.30103, d1 = 155.43, p1 = 3489.8; at 1 km
  // 0.15543 + e^-0.28655 * 0.84457 = 0.7896.
  CHECK(Tr36777{"RMa-AV"}.line_of_sight_probability(over_ground(1000.0, 20.0)) ==
        Approx(0.7896).margin(0.0005));
  // Certain near by, and high above the macro cells.
  CHECK(Tr36777{"UMi-AV"}.line_of_sight_probability(over_ground(18.0, 30.0)) == 1.0);
  CHECK(Tr36777{"RMa-AV"}.line_of_sight_probability(over_ground(9000.0, 40.1)) == 1.0);
  CHECK(Tr36777{"UMa-AV"}.line_of_sight_probability(over_ground(9000.0, 100.1)) == 1.0);
  CHECK(Tr36777{"UMi-AV"}.line_of_sight_probability(over_ground(9000.0, 100.1)) < 0.1);
}

TEST_CASE("3GPP's losses are those worked out by hand") {
  // 2 GHz, 500 m apart at one height of 50 m: lg d = 2.69897, lg h = 1.69897, 20 lg 2 = 6.0206,
  // 20 lg(40 pi 2 / 3) = 38.4626.
  const LinkGeometry link = over_ground(500.0, 50.0, 50.0);
  // 20.842 * 2.69897 + 38.4626; -12 + 25.9955 * 2.69897 + 38.4626
  CHECK(Tr36777{"RMa-AV"}.loss(link, true).value == Approx(94.714).margin(0.01));
  CHECK(Tr36777{"RMa-AV"}.loss(link, false).value == Approx(96.624).margin(0.01));
  // 28 + 22 * 2.69897 + 6.0206; -17.5 + 34.1072 * 2.69897 + 38.4626
  CHECK(Tr36777{"UMa-AV"}.loss(link, true).value == Approx(93.398).margin(0.01));
  CHECK(Tr36777{"UMa-AV"}.loss(link, false).value == Approx(113.017).margin(0.01));
  // 30.9 + 21.4005 * 2.69897 + 6.0206 = 94.680, above free space; 32.4 + 30.2878 * 2.69897 + 6.0206
  CHECK(Tr36777{"UMi-AV"}.loss(link, true).value == Approx(94.680).margin(0.01));
  CHECK(Tr36777{"UMi-AV"}.loss(link, false).value == Approx(120.166).margin(0.01));
}

TEST_CASE("a drawn link has line of sight as often as the model says, and keeps it near by") {
  // Places far apart compared with the decorrelation distance are as good as independent.
  const AerialLoss drawn{std::make_unique<AlHourani>("urban"),
                         AerialLoss::Draw{.decorrelation_m = 10.0, .seed = 4}};
  const AlHourani urban{"urban"};
  constexpr int kLinks = 4000;
  int seen = 0;
  int changed = 0;
  for (int i = 0; i < kLinks; ++i) {
    LinkGeometry link = at_elevation(24.0);
    const Eigen::Vector3d shift{137.0 * (i % 60), 211.0 * (i / 60), 0.0};
    link.p_WT += shift;
    link.p_WR += shift;
    const bool sight = drawn.loss(link) == urban.loss(link, true);
    REQUIRE((sight || drawn.loss(link) == urban.loss(link, false)));
    seen += sight ? 1 : 0;
    link.p_WR += Eigen::Vector3d{0.1, 0.0, 0.0};
    changed += (drawn.loss(link).value < urban.loss(link, true).value + 1.0) != sight ? 1 : 0;
  }
  const double p = urban.line_of_sight_probability(at_elevation(24.0));
  // Four standard deviations of the count, 3 %.
  CHECK(seen / static_cast<double>(kLinks) ==
        Approx(p).margin(4.0 * std::sqrt(p * (1 - p) / kLinks)));
  // 0.1 m of 10 m: the field correlates by e^-0.01, and its sign changes with arccos(e^-0.01)/pi.
  CHECK(changed < kLinks * 0.08);
  CHECK(changed > 0);
}

TEST_CASE("the mean of a link lies between its losses, weighed by chance") {
  const AerialLoss mean{std::make_unique<Tr36777>("UMa-AV"), std::nullopt};
  const Tr36777 model{"UMa-AV"};
  const LinkGeometry link = over_ground(300.0, 40.0);
  const double p = model.line_of_sight_probability(link);

  CHECK(mean.loss(link).value ==
        Approx(p * model.loss(link, true).value + (1.0 - p) * model.loss(link, false).value));
}

TEST_CASE("a street's loss lies between its bounds around the break-point") {
  // 2 GHz, h1 = 10 m, h2 = 2 m: L_bp = |20 lg(0.149896^2 / (8 pi 20))| = 86.996 dB, R_bp = 533.7 m.
  const auto loss_db = [](const char* bound, double distance_m) {
    return StreetCanyon{bound}
        .loss({.p_WT = {0.0, 0.0, 10.0},
               .p_WR = {std::sqrt(distance_m * distance_m - 64.0), 0.0, 2.0},
               .carrier_hz = kCarrier_hz})
        .value;
  };
  CHECK(loss_db("lower", 533.7) == Approx(86.996).margin(0.01));
  CHECK(loss_db("upper", 533.7) == Approx(106.996).margin(0.01));
  CHECK(loss_db("middle", 533.7) == Approx(96.996).margin(0.01));
  CHECK(loss_db("lower", 53.37) == Approx(66.996).margin(0.01));
  CHECK(loss_db("upper", 53.37) == Approx(81.996).margin(0.01));
  CHECK(loss_db("lower", 5337.0) == Approx(126.996).margin(0.01));
  CHECK(loss_db("upper", 5337.0) == Approx(146.996).margin(0.01));
  // Six decibels below free space before the break-point: 20 lg(2 pi d / lambda).
  CHECK(loss_db("lower", 100.0) ==
        Approx(20.0 * std::log10(2.0 * std::numbers::pi * 100.0 / 0.14989623)).margin(1e-3));
}

TEST_CASE(
    "aerial and street losses are the same in both directions, and change by little in a "
    "centimetre") {
  const auto* const model = GENERATE("p1411", "al-hourani", "tr36777");
  const auto* const sight = GENERATE("drawn", "mean");
  const Channel channel{{.model = model, .carrier_hz = kCarrier_hz, .line_of_sight = sight}};
  double previous_db = -1.0;
  int jumps = 0;
  for (double x_m = -60.0; x_m < 60.0; x_m += 0.01) {
    const Eigen::Vector3d p_WA{0.0, 0.0, -1.0};
    const Eigen::Vector3d p_WB{x_m, 20.0, 35.0};
    const double loss_db = channel.static_loss(Link::between(0, p_WA, 1, p_WB)).value;
    REQUIRE(channel.static_loss(Link::between(1, p_WB, 0, p_WA)).value == loss_db);
    REQUIRE(std::isfinite(loss_db));
    REQUIRE(loss_db >= 0.0);
    jumps += previous_db >= 0.0 && std::abs(loss_db - previous_db) > 0.05 ? 1 : 0;
    previous_db = loss_db;
  }
  // A drawn line of sight is gained and lost at once, as around a corner; within 120 m a few times.
  CHECK(jumps <= (std::string{sight} == "drawn" && std::string{model} != "p1411" ? 12 : 0));
}

TEST_CASE("names that do not exist are refused with those that do") {
  CHECK_THROWS_WITH(AlHourani{"rural"},
                    "propagation model 'al-hourani': environment 'rural' is not known; allowed are "
                    "'suburban', 'urban', 'dense-urban', 'high-rise'");
  CHECK_THROWS_WITH(Tr36777{"UMa"},
                    "propagation model 'tr36777': scenario 'UMa' is not known; allowed are "
                    "'RMa-AV', 'UMa-AV', 'UMi-AV'");
  CHECK_THROWS_WITH(StreetCanyon{"median"},
                    "propagation model 'p1411': bound 'median' is not known; allowed are "
                    "'lower', 'middle', 'upper'");
  CHECK_THROWS_WITH((Channel{{.model = "tr36777", .line_of_sight = "never"}}),
                    "propagation model 'tr36777': line of sight must be 'drawn' or 'mean'");
}

}  // namespace
}  // namespace cuscus::netsim
