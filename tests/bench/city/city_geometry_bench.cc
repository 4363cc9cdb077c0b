// What the geometry of a city costs. Prints a CSV table, in ns of CPU per query.
//
// The city is one like Manhattan's Midtown: as many buildings, corners and heights per area, on a
// grid of streets. On its own, no file needed.
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "common/city/geometry/city_geometry.h"
#include "common/random/counter_stream.h"

namespace {

using namespace cuscus::city;  // NOLINT(google-build-using-namespace): a main

double cpu_ns() { return static_cast<double>(std::clock()) * (1e9 / CLOCKS_PER_SEC); }

class Draw {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * draws_.uniform(next_++);
  }

 private:
  cuscus::random::CounterStream draws_{1, 1};
  std::uint64_t next_{0};
};

/// A rectangle whose sides have bays, 4 + 4 corners per bay.
Ring with_bays(double west, double south, double east, double north, int bays) {
  Ring ring{{west, south}};
  for (int i = 0; i < bays; ++i) {
    const double step = (east - west) / (2 * bays + 1);
    const double x = west + (2 * i + 1) * step;
    ring.insert(ring.end(),
                {{x, south}, {x, south + 1.0}, {x + step, south + 1.0}, {x + step, south}});
  }
  ring.insert(ring.end(), {{east, south}, {east, north}, {west, north}});
  return ring;
}

/// 20 by 20 blocks of 20 lots each: 8 000 buildings on 3.7 km².
City midtown(Draw& draw) {
  constexpr int kBlocks = 20;
  constexpr double kBlock_m = 80.0;
  constexpr double kStreet_m = 16.0;
  City city;
  for (int block = 0; block < kBlocks * kBlocks; ++block) {
    const double west = (block % kBlocks) * (kBlock_m + kStreet_m);
    const double south = static_cast<double>(block / kBlocks) * (kBlock_m + kStreet_m);
    for (int lot = 0; lot < 20; ++lot) {
      const double x = west + (lot % 10) * 8.0;
      const double y = south + static_cast<double>(lot / 10) * 40.0;
      const double top_m = draw(0.0, 1.0) < 0.1 ? draw(60.0, 250.0) : draw(12.0, 60.0);
      Building building;
      building.prisms.push_back(
          {.footprint = {.outer = with_bays(x, y, x + 8.0, y + draw(20.0, 38.0), 1),
                         .courtyards = {}},
           .bottom_m = 0.0,
           .top_m = top_m});
      city.buildings.push_back(std::move(building));
    }
  }
  return city;
}

struct Link {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

/// Both ends outdoors and 10 to 120 m up, at most so far apart.
std::vector<Link> links(const CityGeometry& geometry, Draw& draw, double side_m, double longest_m) {
  const auto outdoors = [&](const Eigen::Vector3d& p) { return !geometry.inside(p); };
  std::vector<Link> result;
  while (result.size() < 20'000) {
    const Eigen::Vector3d a{draw(0.0, side_m), draw(0.0, side_m), draw(10.0, 120.0)};
    const double heading_rad = draw(0.0, 6.28);
    const double length_m = longest_m * std::sqrt(draw(0.0, 1.0));
    const Eigen::Vector3d b{a.x() + length_m * std::cos(heading_rad),
                            a.y() + length_m * std::sin(heading_rad), draw(10.0, 120.0)};
    if (outdoors(a) && outdoors(b)) {
      result.push_back({a, b});
    }
  }
  return result;
}

void report(const std::string& query, const std::vector<Link>& asked,
            const std::function<double(const Link&)>& answer) {
  constexpr int kRounds = 5;
  double sum = 0.0;
  const double begin_ns = cpu_ns();
  for (int round = 0; round < kRounds; ++round) {
    for (const Link& link : asked) {
      sum += answer(link);
    }
  }
  const double queries = static_cast<double>(kRounds * asked.size());
  std::cout << query << ',' << (cpu_ns() - begin_ns) / queries << ',' << sum / queries << '\n';
}

void report_links(const CityGeometry& geometry, const std::string& reach,
                  const std::vector<Link>& asked) {
  Crossings found;
  std::vector<std::uint32_t> buildings;
  report("line of sight, " + reach, asked,
         [&](const Link& link) { return geometry.blocked(link.a, link.b) ? 1.0 : 0.0; });
  report("walls, " + reach, asked, [&](const Link& link) {
    geometry.crossings(link.a, link.b, found);
    double walls = 0.0;
    for (const Crossing& crossing : found.buildings) {
      walls += crossing.outer_walls;
    }
    return walls;
  });
  report("walls, turns and clearances, " + reach, asked, [&](const Link& link) {
    geometry.crossings(link.a, link.b, found);
    geometry.near(link.a, link.b, 2.0, buildings);
    double sum = 0.0;
    std::size_t next = 0;
    for (const std::uint32_t building : buildings) {
      if (next < found.buildings.size() && found.buildings[next].building == building) {
        sum += geometry.turns(building, link.a, link.b).over.at_a;
        ++next;
      } else {
        sum += geometry.clearance_m(building, link.a, link.b) < 0.02 ? 1.0 : 0.0;
      }
    }
    return sum;
  });
}

void report_flight(const CityGeometry& geometry, const std::vector<Link>& asked) {
  report("first hit within 300 m", asked, [&](const Link& link) {
    const auto hit = geometry.first_hit(link.a, link.b - link.a, 300.0);
    return hit ? hit->distance_m : 300.0;
  });
  report("nearest surface within 10 m", asked, [&](const Link& link) {
    const auto surface = geometry.nearest(link.a, 10.0);
    return surface ? surface->distance_m : 10.0;
  });
  report("a ball's step of 1 cm", asked, [&](const Link& link) {
    const Eigen::Vector3d step = 0.01 * (link.b - link.a).normalized();
    return geometry.sweep(link.a, link.a + step, 0.3) ? 1.0 : 0.0;
  });
  report("a ball's step of 50 m", asked, [&](const Link& link) {
    const Eigen::Vector3d step = 50.0 * (link.b - link.a).normalized();
    const auto contact = geometry.sweep(link.a, link.a + step, 0.3);
    return contact ? contact->t : 1.0;
  });
  report("inside", asked, [&](const Link& link) { return geometry.inside(link.a) ? 1.0 : 0.0; });
}

}  // namespace

int main() {
  Draw draw;
  const City city = midtown(draw);
  const double begin_ns = cpu_ns();
  const CityGeometry geometry{city};
  std::cout << "query,ns,mean_answer\nbuild," << cpu_ns() - begin_ns << ',' << city.buildings.size()
            << '\n';
  constexpr double kSide_m = 1900.0;
  const std::vector<Link> near = links(geometry, draw, kSide_m, 300.0);
  report_links(geometry, "<= 300 m", near);
  report_links(geometry, "<= 3 km", links(geometry, draw, kSide_m, 3000.0));
  report_flight(geometry, near);
  return 0;
}
