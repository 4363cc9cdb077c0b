// What the simulator costs: nanoseconds of CPU per reception, all in range. Prints a CSV table.
#include <array>
#include <chrono>
#include <ctime>
#include <iostream>

#include "netsim/app/synthetic.h"

namespace {

using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main() {
  std::cout << "layout,nodes,receptions,cpu_s,ns_per_reception\n";
  for (const Layout::Kind layout : {Layout::Kind::kEqualPower, Layout::Kind::kCircle}) {
    for (const std::uint32_t nodes : {10U, 50U, 100U, 300U}) {
      SyntheticParameters p;
      p.senders = nodes;
      p.layout.kind = layout;
      p.layout.circle_radius_m = 100.0;
      p.duration = std::chrono::seconds{nodes > 100 ? 2 : 10};
      const double begin_s = cpu_s();
      const SyntheticResult r = run_synthetic(p);
      const double used_s = cpu_s() - begin_s;
      // Every transmission is an attempt at reception by all others, whatever comes of it.
      double arrivals = 0.0;
      for (const Tally& tally : r.tallies) {
        arrivals += static_cast<double>(tally.transmissions) * (nodes - 1.0);
      }
      std::cout << (layout == Layout::Kind::kCircle ? "circle" : "equal") << ',' << nodes << ','
                << arrivals << ',' << used_s << ',' << used_s * 1e9 / arrivals << '\n';
    }
  }
  return 0;
}
