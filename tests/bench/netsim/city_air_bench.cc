// What a transmission costs among the towers of a generated grid, beside what it costs without
// them: beacons of UAVs that stand, or fly on circles, and that the world moves every millisecond.
// Prints a Markdown table of ns of CPU.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/city/generate/generate.h"
#include "common/city/geometry/city_geometry.h"
#include "common/city/import/import_city.h"
#include "common/random/counter_stream.h"
#include "netsim/air/air.h"
#include "netsim/channel/city_obstacles.h"

namespace {

using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main

double cpu_ns() { return static_cast<double>(std::clock()) * (1e9 / CLOCKS_PER_SEC); }

/// The world's: a new version every millisecond, whether or not somebody has moved.
class Fleet final : public PositionSource {
 public:
  Fleet(std::vector<Eigen::Vector3d> centres, double speed_mps)
      : centres_{std::move(centres)}, p_WN_{centres_}, speed_mps_{speed_mps} {}

  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions(SimTime now) override {
    constexpr std::int64_t kStep_ns = 1'000'000;
    constexpr double kRadius_m = 8.0;
    const auto step = static_cast<std::uint64_t>(to_ns(now) / kStep_ns);
    if (step + 1 == version_) {
      return p_WN_;
    }
    version_ = step + 1;
    const double angle_rad = speed_mps_ / kRadius_m * static_cast<double>(step) * 1e-3;
    for (std::size_t node = 0; node < p_WN_.size(); ++node) {
      const double at_rad = angle_rad + static_cast<double>(node);
      p_WN_[node] =
          centres_[node] + kRadius_m * Eigen::Vector3d{std::cos(at_rad), std::sin(at_rad), 0.0};
    }
    return p_WN_;
  }
  [[nodiscard]] std::uint64_t version() const override { return version_; }

 private:
  std::vector<Eigen::Vector3d> centres_;
  std::vector<Eigen::Vector3d> p_WN_;
  double speed_mps_;
  std::uint64_t version_{0};
};

class Nobody final : public AirListener {
 public:
  void delivered(const Delivery& /*delivery*/) override {}
  void finished(const FrameReport& /*report*/) override {}
};

struct Town {
  std::shared_ptr<const city::CityGeometry> geometry;
  std::shared_ptr<const Obstacles> obstacles;
  double half_m;
};

Town grid_town() {
  const city::generate::Request request{.style = city::generate::Style::kGrid};
  const std::string text = city::generate::make_osm(request);
  const auto imported = city::import_city_text(text, city::OsmFormat::kXml, "grid", {});
  auto geometry = std::make_shared<const city::CityGeometry>(imported.city);
  auto obstacles =
      std::make_shared<const CityObstacles>(imported.city, geometry, paper_walls(2.437e9));
  return {.geometry = geometry, .obstacles = obstacles, .half_m = request.size_m / 2.0};
}

/// In streets and above roofs, with room for a circle.
std::vector<Eigen::Vector3d> places(const Town& town, std::uint32_t nodes) {
  std::vector<Eigen::Vector3d> found;
  const random::CounterStream draws{5, 1};
  for (std::uint64_t draw = 0; found.size() < nodes; draw += 3) {
    const auto uniform = [&](std::uint64_t i, double low, double high) {
      return low + (high - low) * draws.uniform(draw + i);
    };
    const Eigen::Vector3d p{uniform(0, -town.half_m, town.half_m),
                            uniform(1, -town.half_m, town.half_m), uniform(2, 9.0, 120.0)};
    if (!town.geometry->nearest(p, 8.5)) {
      found.push_back(p);
    }
  }
  return found;
}

struct Load {
  std::uint32_t nodes;
  double speed_mps;
  Duration period;
};

double ns_per_transmission(const std::vector<Eigen::Vector3d>& centres,
                           std::shared_ptr<const Obstacles> obstacles, const Load& load) {
  constexpr double kTransmissions = 4'000.0;
  AirParameters parameters;
  parameters.nodes.assign(load.nodes, AirNode{});
  parameters.channel.carrier_hz = 2.437e9;
  parameters.channel.city = std::move(obstacles);
  Fleet fleet{centres, load.speed_mps};
  Nobody nobody;
  Air air{parameters, fleet, nobody};
  const auto rounds = static_cast<std::uint64_t>(kTransmissions / load.nodes);
  const double begin_ns = cpu_ns();
  for (std::uint64_t round = 0; round < rounds; ++round) {
    const SimTime begin{load.period * static_cast<std::int64_t>(round)};
    for (std::uint32_t node = 0; node < load.nodes; ++node) {
      air.offer(node, begin + load.period * node / load.nodes, {.psdu_bytes = 130});
    }
    air.run_until(begin + load.period);
  }
  const double used_ns = cpu_ns() - begin_ns;
  std::uint64_t sent = 0;
  for (std::uint32_t node = 0; node < load.nodes; ++node) {
    sent += air.tally(node).transmissions;
  }
  return used_ns / static_cast<double>(sent);
}

}  // namespace

int main() {
  using std::chrono::milliseconds;
  const Town town = grid_town();
  std::cout
      << "| UAVs | speed m/s | period ms | ns per transmission | without a city | per link |\n"
         "| --- | --- | --- | --- | --- | --- |\n";
  for (const std::uint32_t nodes : {20U, 100U}) {
    const auto centres = places(town, nodes);
    for (const double speed_mps : {0.0, 2.0, 10.0, 20.0}) {
      for (const Duration period : {Duration{milliseconds{100}}, Duration{milliseconds{20}}}) {
        if (nodes == 100 && period < milliseconds{100}) {
          continue;  // more than the air takes
        }
        const Load load{.nodes = nodes, .speed_mps = speed_mps, .period = period};
        const double city_ns = ns_per_transmission(centres, town.obstacles, load);
        const double bare_ns = ns_per_transmission(centres, nullptr, load);
        std::cout << fmt::format("| {} | {:.0f} | {} | {:.0f} | {:.0f} | {:.0f} |\n", nodes,
                                 speed_mps, period / milliseconds{1}, city_ns, bare_ns,
                                 (city_ns - bare_ns) / (nodes - 1));
      }
    }
  }
  return 0;
}
