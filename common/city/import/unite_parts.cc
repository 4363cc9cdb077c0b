#include "common/city/import/unite_parts.h"

#include <algorithm>
#include <tuple>

#include "common/city/import/footprints.h"

namespace cuscus::city {
namespace {

bool overlap_in_height(const Prism& one, const Prism& other) {
  return one.bottom_m < other.top_m && other.bottom_m < one.top_m;
}

/// Of `taken` those that share volume with the prism, or may.
std::vector<const Prism*> rivals_of(const Prism& prism, const std::vector<Prism>& taken) {
  std::vector<const Prism*> rivals;
  const Eigen::AlignedBox2d box = bounds_of(prism.footprint);
  for (const Prism& other : taken) {
    if (overlap_in_height(prism, other) && box.intersects(bounds_of(other.footprint)) &&
        overlap_m2(prism.footprint, other.footprint) > kTouching_m2) {
      rivals.push_back(&other);
    }
  }
  return rivals;
}

/// Adds to `taken` what of the prism is free, in slabs between its rivals' tops and bottoms; false
/// when nothing is.
bool add_free(const Prism& prism, UnitedPrisms& united) {
  const std::vector<const Prism*> rivals = rivals_of(prism, united.prisms);
  if (rivals.empty()) {
    united.prisms.push_back(prism);
    return true;
  }
  std::vector<double> levels_m{prism.bottom_m, prism.top_m};
  for (const Prism* rival : rivals) {
    for (const double level_m : {rival->bottom_m, rival->top_m}) {
      if (level_m > prism.bottom_m && level_m < prism.top_m) {
        levels_m.push_back(level_m);
      }
    }
  }
  std::ranges::sort(levels_m);
  levels_m.erase(std::unique(levels_m.begin(), levels_m.end()), levels_m.end());
  std::vector<Prism> free;
  for (std::size_t i = 0; i + 1 < levels_m.size(); ++i) {
    Prism slab{.footprint = {}, .bottom_m = levels_m[i], .top_m = levels_m[i + 1]};
    std::vector<const Footprint*> beside;
    for (const Prism* rival : rivals) {
      if (overlap_in_height(slab, *rival)) {
        beside.push_back(&rival->footprint);
      }
    }
    for (Footprint& piece : subtract(prism.footprint, beside, kThinnestPiece_m)) {
      slab.footprint = std::move(piece);
      free.push_back(slab);
    }
  }
  std::ranges::move(free, std::back_inserter(united.prisms));
  return !free.empty();
}

}  // namespace

UnitedPrisms unite_parts(const std::vector<Prism>& outlines, const std::vector<Prism>& parts) {
  UnitedPrisms united;
  std::vector<std::tuple<double, double, std::size_t>> order;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    order.emplace_back(-parts[i].top_m, -area_m2(parts[i].footprint), i);
  }
  std::ranges::sort(order);
  for (const auto& entry : order) {
    const std::size_t part = std::get<2>(entry);
    if (!add_free(parts[part], united)) {
      united.hidden_parts.push_back(part);
    }
  }
  std::vector<const Footprint*> covered;
  covered.reserve(parts.size());
  for (const Prism& part : parts) {
    covered.push_back(&part.footprint);
  }
  for (const Prism& outline : outlines) {
    for (Footprint& piece : subtract(outline.footprint, covered, kThinnestPiece_m)) {
      united.prisms.push_back(
          {.footprint = std::move(piece), .bottom_m = outline.bottom_m, .top_m = outline.top_m});
    }
  }
  return united;
}

}  // namespace cuscus::city
