// What the simulator costs: CPU per reception with all in range, and how much faster than real time
// a thousand nodes over 25 km^2 are. Prints Markdown tables.
#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <ctime>
#include <iostream>
#include <string>

#include "common/random/counter_stream.h"
#include "netsim/app/synthetic.h"

namespace {

using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main
using std::chrono::milliseconds;
using std::chrono::seconds;

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Cost {
  double cpu_s{};
  double arrivals{};    ///< Transmissions at receivers, whatever comes of them.
  double neighbours{};  ///< Receivers per transmission.
};

Cost measure(const SyntheticParameters& p) {
  const double begin_s = cpu_s();
  const SyntheticResult r = run_synthetic(p);
  Cost cost{.cpu_s = cpu_s() - begin_s};
  double transmissions = 0.0;
  double received = 0.0;
  for (const Tally& tally : r.tallies) {
    transmissions += static_cast<double>(tally.transmissions);
    received += static_cast<double>(tally.received);
  }
  cost.arrivals = transmissions * (static_cast<double>(r.tallies.size()) - 1.0);
  cost.neighbours = received / transmissions;
  return cost;
}

/// What a random number costs here and now: the measure of how fast this machine is.
double ns_per_draw() {
  constexpr std::uint64_t kDraws = 20'000'000;
  const random::CounterStream stream{1, 1};
  const double begin_s = cpu_s();
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    sum += stream.bits(i);
  }
  const double used_s = cpu_s() - begin_s;
  return sum == 0 ? 0.0 : used_s * 1e9 / kDraws;
}

void all_in_range() {
  std::cout << "Beacons of 64 B every 50 ms, all in range, 6 Mb/s:\n\n"
               "| layout | N | receptions | CPU s | CPU ns per reception | draws per reception |\n"
               "| --- | --- | --- | --- | --- | --- |\n";
  for (const Layout::Kind layout : {Layout::Kind::kEqualPower, Layout::Kind::kCircle}) {
    for (const std::uint32_t nodes : {10U, 50U, 100U, 300U}) {
      SyntheticParameters p;
      p.senders = nodes;
      p.layout.kind = layout;
      p.layout.circle_radius_m = 100.0;
      p.duration = seconds{nodes > 100 ? 2 : 10};
      const Cost cost = measure(p);
      const double ns = cost.cpu_s * 1e9 / cost.arrivals;
      std::cout << fmt::format("| {} | {} | {:.0f} | {:.2f} | {:.0f} | {:.1f} |\n",
                               layout == Layout::Kind::kCircle ? "circle" : "equal powers", nodes,
                               cost.arrivals, cost.cpu_s, ns, ns / ns_per_draw());
    }
  }
}

/// A thousand nodes anywhere in 5 km x 5 km, up to 100 m above ground, exponent 3.
SyntheticParameters wide(double tx_power_dbm) {
  constexpr std::uint32_t kNodes = 1'000;
  constexpr double kSide_m = 5'000.0;
  constexpr double kHeight_m = 100.0;
  SyntheticParameters p;
  p.senders = kNodes;
  p.layout.kind = Layout::Kind::kGiven;
  for (std::uint32_t i = 0; i < kNodes; ++i) {
    const random::CounterStream place{7, i};
    p.layout.p_WN_m.emplace_back(kSide_m * place.uniform(0), kSide_m * place.uniform(1),
                                 kHeight_m * place.uniform(2));
  }
  p.air.nodes.assign(kNodes, AirNode{.tx_power = {tx_power_dbm}});
  p.air.channel.model = "log-distance";
  p.air.channel.exponent = 3.0;
  p.traffic.period = milliseconds{100};
  p.duration = seconds{5};
  return p;
}

void far_apart() {
  std::cout << "\n1 000 nodes over 25 km^2, path-loss exponent 3, beacons of 64 B every 100 ms, "
               "6 Mb/s:\n\n"
               "| TX power dBm | receivers per beacon | simulated s | CPU s | times real time |\n"
               "| --- | --- | --- | --- | --- |\n";
  for (const double tx_power_dbm : {16.0, 24.0, 30.0, 36.0}) {
    const SyntheticParameters p = wide(tx_power_dbm);
    const Cost cost = measure(p);
    const double simulated_s = to_seconds(p.warm_up + p.duration);
    std::cout << fmt::format("| {:.0f} | {:.1f} | {:.1f} | {:.2f} | {:.1f} |\n", tx_power_dbm,
                             cost.neighbours, simulated_s, cost.cpu_s, simulated_s / cost.cpu_s);
  }
}

}  // namespace

int main() {
  std::cout << fmt::format("One random number (Philox 4x32-10): {:.1f} ns of CPU.\n\n",
                           ns_per_draw());
  all_in_range();
  far_apart();
  return 0;
}
