// What the static loss of a link costs among houses. Prints a CSV table.
#include <cstdint>
#include <ctime>
#include <iostream>
#include <vector>

#include "common/random/counter_stream.h"
#include "netsim/channel/channel.h"

namespace {

using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main

double cpu_ns() { return static_cast<double>(std::clock()) * (1e9 / CLOCKS_PER_SEC); }

}  // namespace

int main() {
  constexpr double kSide_m = 500.0;
  constexpr std::uint32_t kNodes = 100;
  constexpr int kRounds = 20;
  const cuscus::random::CounterStream draws{1, 1};
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * draws.uniform(draw++);
  };
  std::vector<Eigen::Vector3d> p_WN;
  for (std::uint32_t node = 0; node < kNodes; ++node) {
    p_WN.emplace_back(uniform(0.0, kSide_m), uniform(0.0, kSide_m), uniform(1.0, 30.0));
  }

  std::cout << "boxes,links,obstructed,ns_per_link\n";
  std::vector<BoxObstacle> boxes;
  for (const std::size_t count : {0U, 10U, 30U, 100U, 300U}) {
    while (boxes.size() < count) {
      boxes.push_back({.shape = {.centre_m = {uniform(0.0, kSide_m), uniform(0.0, kSide_m)},
                                 .size_m = {uniform(8.0, 20.0), 12.0, uniform(6.0, 20.0)},
                                 .heading_rad = uniform(0.0, 3.0)}});
    }
    const Channel channel{{.obstacles = boxes}};
    std::uint64_t links = 0;
    std::uint64_t obstructed = 0;
    const double begin_ns = cpu_ns();
    for (int round = 0; round < kRounds; ++round) {
      for (std::uint32_t a = 0; a < kNodes; ++a) {
        for (std::uint32_t b = a + 1; b < kNodes; ++b) {
          const StaticTerms terms = channel.static_terms(Link::between(a, p_WN[a], b, p_WN[b]));
          obstructed += terms.obstacles.walls.outer > 0 ? 1 : 0;
          ++links;
        }
      }
    }
    std::cout << count << ',' << links << ',' << obstructed << ','
              << (cpu_ns() - begin_ns) / static_cast<double>(links) << '\n';
  }
  return 0;
}
