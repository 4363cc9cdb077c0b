#include "common/city/generate/voronoi.h"

#include <algorithm>
#include <cmath>

#include "common/city/generate/dice.h"

namespace cuscus::city::generate {
namespace {

constexpr int kNoSite = -1;
// A site keeps this far, in fields, from the middle of its field.
constexpr double kJitter = 0.38;
// Of every third field on the diagonals, so that no two neighbours are empty.
constexpr double kEmptyFields = 0.45;
// No point is further than 2 sqrt(2) fields from a site, so that Voronoi neighbours are within
// 4 sqrt(2) < 6 fields.
constexpr int kReach = 6;

struct Board {
  int fields{0};  ///< Per side.
  std::vector<Eigen::Vector2d> sites;
  std::vector<int> site_of;  ///< Per field, by rows.

  [[nodiscard]] int site(int column, int row) const {
    const bool inside = column >= 0 && row >= 0 && column < fields && row < fields;
    const auto across = static_cast<std::size_t>(fields);
    return inside
               ? site_of[static_cast<std::size_t>(row) * across + static_cast<std::size_t>(column)]
               : kNoSite;
  }
};

Board place_sites(const CellPattern& pattern, std::uint64_t seed) {
  Board board;
  board.fields = std::max(3, static_cast<int>(std::lround(pattern.size_m / pattern.pitch_m)));
  const double field_m = pattern.size_m / board.fields;
  Dice dice{seed, Purpose::kSites};
  for (int row = 0; row < board.fields; ++row) {
    for (int column = 0; column < board.fields; ++column) {
      const Eigen::Vector2d middle{column + 0.5, row + 0.5};
      const Eigen::Vector2d aside{dice.uniform(-kJitter, kJitter), dice.uniform(-kJitter, kJitter)};
      const bool empty = dice.chance(kEmptyFields) && (row + column) % 3 == 0;
      board.site_of.push_back(empty ? kNoSite : static_cast<int>(board.sites.size()));
      if (!empty) {
        board.sites.emplace_back((middle + aside) * field_m -
                                 Eigen::Vector2d::Constant(pattern.size_m / 2.0));
      }
    }
  }
  return board;
}

/// The points that are no nearer to `other` than to `site`.
HalfPlane nearer_to(const Eigen::Vector2d& site, const Eigen::Vector2d& other) {
  const Eigen::Vector2d towards = (other - site).normalized();
  return {towards, towards.dot((site + other) / 2.0)};
}

}  // namespace

std::vector<ConvexCell> irregular_cells(const CellPattern& pattern, std::uint64_t seed) {
  const Board board = place_sites(pattern, seed);
  const Eigen::Vector2d corner = Eigen::Vector2d::Constant(pattern.size_m / 2.0);
  std::vector<ConvexCell> cells;
  for (int row = 0; row < board.fields; ++row) {
    for (int column = 0; column < board.fields; ++column) {
      const int self = board.site(column, row);
      if (self == kNoSite) {
        continue;
      }
      const Eigen::Vector2d& site = board.sites[static_cast<std::size_t>(self)];
      ConvexCell cell = rectangle(-corner, corner);
      for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
          const int other = board.site(column + dx, row + dy);
          if (other != kNoSite && other != self) {
            cell = clip(cell, nearer_to(site, board.sites[static_cast<std::size_t>(other)]), other);
          }
        }
      }
      cells.push_back(std::move(cell));
    }
  }
  return cells;
}

}  // namespace cuscus::city::generate
