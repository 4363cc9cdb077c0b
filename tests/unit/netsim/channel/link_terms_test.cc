#include "netsim/channel/link_terms.h"

#include <array>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/city/generate/generate.h"
#include "common/city/import/import_city.h"
#include "common/random/counter_stream.h"
#include "netsim/channel/city_obstacles.h"

namespace cuscus::netsim {
namespace {

constexpr double kCarrier_hz = 2.437e9;
constexpr double kHalf_m = 150.0;

std::shared_ptr<const CityObstacles> made_up(city::generate::Style style) {
  const std::string text =
      city::generate::make_osm({.style = style, .seed = 3, .size_m = 2.0 * kHalf_m});
  city::ImportOptions options;
  options.rule.room_m = 5.0;
  const auto imported = city::import_city_text(text, city::OsmFormat::kXml, "made up", options);
  return std::make_shared<CityObstacles>(imported.city,
                                         std::make_shared<const city::CityGeometry>(imported.city),
                                         paper_walls(kCarrier_hz));
}

struct Draw {
  random::CounterStream draws{20'261'127, 2};
  std::uint64_t next{0};

  double operator()(double low, double high) { return low + (high - low) * draws.uniform(next++); }
  Eigen::Vector3d place() {
    return {(*this)(-kHalf_m, kHalf_m), (*this)(-kHalf_m, kHalf_m), (*this)(1.0, 60.0)};
  }
};

bool same(const StaticTerms& a, const StaticTerms& b) {
  const auto same_obstacles = [](const ObstacleTerms& x, const ObstacleTerms& y) {
    return x.walls.outer == y.walls.outer && x.walls.inner == y.walls.inner &&
           x.outer_walls == y.outer_walls && x.inner_walls == y.inner_walls &&
           x.diffraction == y.diffraction && x.foliage == y.foliage;
  };
  return a.basic == b.basic && a.shadowing == b.shadowing &&
         same_obstacles(a.obstacles, b.obstacles);
}

/// Some stand, some drift by millimetres, some fly, some are suddenly elsewhere.
void move(std::vector<Eigen::Vector3d>& p_WN, Draw& draw) {
  for (Eigen::Vector3d& p : p_WN) {
    const double kind = draw(0.0, 1.0);
    if (kind > 0.98) {
      p = draw.place();
    } else if (kind > 0.3) {
      const double step_m = kind > 0.6 ? 1.5 : 2e-3;
      p += step_m * Eigen::Vector3d{draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0)};
    }
  }
}

TEST_CASE(
    "kept or not, a link among buildings and trees has the terms of the channel, to the bit") {
  const auto style = GENERATE(city::generate::Style::kGrid, city::generate::Style::kOldTown);
  const std::string model = GENERATE(std::string{"friis"}, std::string{"paper-eq1"});
  const Channel channel{
      {.model = model,
       .carrier_hz = kCarrier_hz,
       .shadowing_db = 4.0,
       .obstacles = {{.shape = {.centre_m = {5.0, 3.0}, .size_m = {6.0, 4.0, 12.0}}},
                     {.shape = {.centre_m = {60.0, -40.0}, .size_m = {9.0, 9.0, 30.0}}}},
       .city = made_up(style)}};
  constexpr std::uint32_t kNodes = 14;
  Draw draw;
  std::vector<Eigen::Vector3d> p_WN;
  for (std::uint32_t node = 0; node < kNodes; ++node) {
    p_WN.push_back(draw.place());
  }
  LinkTerms links{channel, kNodes};
  int wrong = 0;
  int crossed = 0;
  int leafy = 0;

  for (int step = 0; step < 150; ++step) {
    move(p_WN, draw);
    for (std::uint32_t a = 0; a < kNodes; ++a) {
      for (std::uint32_t b = 0; b < kNodes; ++b) {
        if (a != b && draw(0.0, 1.0) < 0.4) {
          const Link link = Link::between(a, p_WN[a], b, p_WN[b]);
          const StaticTerms expected = channel.static_terms(link);
          wrong += same(links.of(link), expected) ? 0 : 1;
          crossed += expected.obstacles.walls.outer > 0 ? 1 : 0;
          leafy += expected.obstacles.foliage.value > 0.0 ? 1 : 0;
        }
      }
    }
  }

  CHECK(wrong == 0);
  CHECK(crossed > 2'000);
  CHECK((model == "paper-eq1" || leafy > 100));
}

/// One wall between west and east, which counts how often it is asked.
class Counted final : public Obstacles {
 public:
  void find(const Eigen::Vector3d& /*p_WA*/, const Eigen::Vector3d& /*p_WB*/, double /*zone_m*/,
            std::vector<Obstruction>& /*found*/) const override {
    ++searches;
  }
  void look_around(const Eigen::Vector3d& /*p_WA*/, const Eigen::Vector3d& /*p_WB*/,
                   double /*zone_m*/, double /*slack_m*/, Nearby& /*nearby*/) const override {
    ++searches;
  }
  void find(const Nearby& /*nearby*/, const Eigen::Vector3d& /*p_WA*/,
            const Eigen::Vector3d& /*p_WB*/, double /*zone_m*/,
            std::vector<Obstruction>& /*found*/) const override {
    ++looks;
  }

  mutable int searches{0};
  mutable int looks{0};
};

TEST_CASE("a link is looked at again when an end has moved, and searched when it has gone far") {
  const auto counted = std::make_shared<Counted>();
  const Channel channel{{.carrier_hz = kCarrier_hz}, counted};
  LinkTerms links{channel, 3};
  std::array<Eigen::Vector3d, 3> p_WN{{{0, 0, 10}, {50, 0, 10}, {0, 50, 10}}};
  const auto ask = [&](std::uint32_t from, std::uint32_t to) {
    static_cast<void>(links.of(Link::between(from, p_WN[from], to, p_WN[to])));
  };
  const auto asked = [&] { return std::array{counted->searches, counted->looks}; };

  ask(0, 1);
  CHECK(asked() == std::array{1, 1});
  ask(1, 0);
  ask(0, 1);
  CHECK(asked() == std::array{1, 1});  // either direction, as long as both stand

  p_WN[2].x() += 1.0;
  ask(0, 1);
  CHECK(asked() == std::array{1, 1});  // a third has moved

  p_WN[1].z() += 1e-9;
  ask(1, 0);
  CHECK(asked() == std::array{1, 2});
  p_WN[1].z() += LinkTerms::kSlack_m / 2.0;
  ask(1, 0);
  CHECK(asked() == std::array{1, 3});
  p_WN[1].z() += LinkTerms::kSlack_m / 2.0;
  ask(1, 0);
  CHECK(asked() == std::array{2, 4});
}

TEST_CASE("with more nodes than links are kept for, links have the same terms") {
  const auto counted = std::make_shared<Counted>();
  const Channel channel{{.carrier_hz = kCarrier_hz}, counted};
  LinkTerms links{channel, LinkTerms::kMostNodes + 1};
  const Link link = Link::between(0, {0, 0, 10}, LinkTerms::kMostNodes, {50, 0, 10});

  CHECK(same(links.of(link), channel.static_terms(link)));
  CHECK(same(links.of(link), channel.static_terms(link)));
  CHECK(counted->looks == 0);
}

}  // namespace
}  // namespace cuscus::netsim
