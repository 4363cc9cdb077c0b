#include "common/city/generate/street_web.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace cuscus::city::generate {
namespace {

/// A junction's name: the three cells, or sides of the area, that meet there.
using Junction = std::array<int, 3>;

constexpr double kStraightest = 0.5;  // cos 60 deg
constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

std::pair<int, int> ordered(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

struct Border {
  std::pair<int, int> cells;
  std::array<Junction, 2> ends{};
  std::array<std::size_t, 2> next{kNobody, kNobody};  ///< The border that goes on, at each end.
};

struct Borders {
  std::vector<Border> all;
  std::map<Junction, Eigen::Vector2d> place;
  std::map<Junction, std::vector<std::size_t>> meeting;
};

Junction junction_at(const std::vector<ConvexCell>& cells, std::size_t cell, std::size_t corner) {
  const ConvexCell& corners = cells[cell];
  const std::size_t before = (corner + corners.size() - 1) % corners.size();
  Junction junction{static_cast<int>(cell), corners[before].across, corners[corner].across};
  std::sort(junction.begin(), junction.end());
  return junction;
}

Borders borders_of(const std::vector<ConvexCell>& cells) {
  Borders borders;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (std::size_t k = 0; k < cells[cell].size(); ++k) {
      const Junction from = junction_at(cells, cell, k);
      borders.place.emplace(from, cells[cell][k].p);
      const int self = static_cast<int>(cell);
      const int across = cells[cell][k].across;
      if (across >= 0 && across < self) {
        continue;  // the other cell has brought it
      }
      const Junction to = junction_at(cells, cell, (k + 1) % cells[cell].size());
      borders.meeting[from].push_back(borders.all.size());
      borders.meeting[to].push_back(borders.all.size());
      borders.all.push_back({ordered(self, across), {from, to}});
    }
  }
  return borders;
}

/// The end of a border that is at the junction.
std::size_t end_at(const Border& border, const Junction& junction) {
  return border.ends[0] == junction ? 0 : 1;
}

Eigen::Vector2d direction_from(const Borders& borders, std::size_t border,
                               const Junction& junction) {
  const Border& it = borders.all[border];
  const Junction& other = it.ends[1 - end_at(it, junction)];
  return (borders.place.at(other) - borders.place.at(junction)).normalized();
}

void join_straightest(Borders& borders) {
  for (const auto& [junction, meeting] : borders.meeting) {
    double best = kStraightest;
    std::optional<std::pair<std::size_t, std::size_t>> pair;
    for (std::size_t i = 0; i < meeting.size(); ++i) {
      for (std::size_t j = i + 1; j < meeting.size(); ++j) {
        const double straight = -direction_from(borders, meeting[i], junction)
                                     .dot(direction_from(borders, meeting[j], junction));
        if (straight > best) {
          best = straight;
          pair = {meeting[i], meeting[j]};
        }
      }
    }
    if (pair) {
      Border& a = borders.all[pair->first];
      Border& b = borders.all[pair->second];
      a.next[end_at(a, junction)] = pair->second;
      b.next[end_at(b, junction)] = pair->first;
    }
  }
}

/// The street that begins at one end of a border.
void walk(const Borders& borders, std::size_t border, std::size_t end, StreetWeb& web) {
  StreetWeb::Street street;
  street.outer = borders.all[border].cells.first < 0;
  Junction at = borders.all[border].ends[end];
  street.axis_m.push_back(borders.place.at(at));
  while (border != kNobody && web.street_between.count(borders.all[border].cells) == 0) {
    const Border& it = borders.all[border];
    web.street_between[it.cells] = web.streets.size();
    const std::size_t far_end = 1 - end_at(it, at);
    at = it.ends[far_end];
    street.length_m += (borders.place.at(at) - street.axis_m.back()).norm();
    street.axis_m.push_back(borders.place.at(at));
    border = it.next[far_end];
  }
  web.streets.push_back(std::move(street));
}

}  // namespace

std::size_t StreetWeb::street_of(int cell, int across) const {
  return street_between.at(ordered(cell, across));
}

StreetWeb street_web(const std::vector<ConvexCell>& cells) {
  Borders borders = borders_of(cells);
  join_straightest(borders);
  StreetWeb web;
  // Streets with ends first; what is left then goes round in circles.
  for (const bool circles : {false, true}) {
    for (std::size_t border = 0; border < borders.all.size(); ++border) {
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
        const Border& it = borders.all[border];
        if ((circles || it.next[end] == kNobody) && web.street_between.count(it.cells) == 0) {
          walk(borders, border, end, web);
        }
      }
    }
  }
  return web;
}

}  // namespace cuscus::city::generate
