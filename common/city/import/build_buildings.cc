#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "common/city/import/building_heights.h"
#include "common/city/import/city_parts.h"
#include "common/city/import/footprints.h"
#include "common/city/import/tag_values.h"
#include "common/city/import/unite_parts.h"

namespace cuscus::city {
namespace {

namespace bgi = boost::geometry::index;
using IndexPoint = boost::geometry::model::d2::point_xy<double>;
using IndexBox = boost::geometry::model::box<IndexPoint>;

IndexBox index_box(const Eigen::AlignedBox2d& box) {
  return {{box.min().x(), box.min().y()}, {box.max().x(), box.max().y()}};
}

struct Shape {
  const AreaRecord* area;
  std::vector<Footprint> footprints;
};

/// Outlines by place.
class OutlineIndex {
 public:
  explicit OutlineIndex(const std::vector<Shape>& outlines) : outlines_{outlines} {
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      for (const Footprint& footprint : outlines[i].footprints) {
        entries.emplace_back(index_box(bounds_of(footprint)), i);
      }
    }
    tree_ = Tree{entries};
  }

  /// The outline that has most of the part; none: no outline has any of it.
  [[nodiscard]] std::optional<std::size_t> owner_of(const Shape& part) const {
    std::vector<Entry> near;
    for (const Footprint& footprint : part.footprints) {
      tree_.query(bgi::intersects(index_box(bounds_of(footprint))), std::back_inserter(near));
    }
    std::ranges::sort(near, {}, &Entry::second);
    const auto last = std::unique(near.begin(), near.end(), [](const Entry& a, const Entry& b) {
      return a.second == b.second;
    });
    near.erase(last, near.end());
    if (const auto only = only_holder(part, near)) {
      return only;
    }
    std::optional<std::size_t> best;
    constexpr double kTouching_m2 = 0.01;
    double most_m2 = kTouching_m2;
    for (const auto& [box, outline] : near) {
      const double shared_m2 = shared(part, outlines_[outline]);
      if (shared_m2 > most_m2) {
        most_m2 = shared_m2;
        best = outline;
      }
    }
    return best;
  }

 private:
  using Entry = std::pair<IndexBox, std::size_t>;
  using Tree = bgi::rtree<Entry, bgi::rstar<16>>;

  /// The outline that all of the part is in, when there is one such. Spares most parts the cost of
  /// shared().
  [[nodiscard]] std::optional<std::size_t> only_holder(const Shape& part,
                                                       const std::vector<Entry>& near) const {
    std::optional<std::size_t> only;
    for (const auto& [box, outline] : near) {
      const auto& footprints = outlines_[outline].footprints;
      const bool holds = std::ranges::all_of(part.footprints, [&](const Footprint& inner) {
        return std::ranges::any_of(footprints, [&](const Footprint& outer) {
          return bounds_of(outer).contains(bounds_of(inner)) && holds_corners(outer, inner);
        });
      });
      if (holds && only) {
        return std::nullopt;
      }
      only = holds ? outline : only;
    }
    return only;
  }

  static double shared(const Shape& part, const Shape& outline) {
    double sum_m2 = 0.0;
    for (const Footprint& a : part.footprints) {
      for (const Footprint& b : outline.footprints) {
        if (bounds_of(a).intersects(bounds_of(b))) {
          sum_m2 += overlap_m2(a, b);
        }
      }
    }
    return sum_m2;
  }

  const std::vector<Shape>& outlines_;
  Tree tree_;
};

std::string_view material_tag(const AreaRecord& area) {
  const std::string_view walls = area.tags["building:facade:material"];
  return walls.empty() ? area.tags["building:material"] : walls;
}

double area_m2(const Shape& shape) {
  double sum_m2 = 0.0;
  for (const Footprint& footprint : shape.footprints) {
    sum_m2 += city::area_m2(footprint);
  }
  return sum_m2;
}

/// Makes one building at a time.
class Builder {
 public:
  Builder(const Site& site, ImportReport& report) : site_{site}, report_{report} {}

  [[nodiscard]] Building build(const Shape& outline, const std::vector<const Shape*>& parts) {
    const AreaRecord& area = *outline.area;
    FileReport& file = report_.files[area.file];
    const auto tagged = tagged_top(area, site_.rule, file);
    const TopHeight own = tagged ? *tagged : top_by_rule(area.object, site_.rule);
    const double base_m = ground_under(outline, parts);
    std::vector<Prism> outline_prisms =
        prisms_of(outline, bottom_m(area, own.top_m, site_.rule, file), own.top_m);
    std::vector<Prism> part_prisms;
    std::vector<const AreaRecord*> part_areas;  // one for each prism
    double highest_m = 0.0;
    HeightSource highest_source = own.source;
    for (const Shape* part : parts) {
      FileReport& part_file = report_.files[part->area->file];
      // A part without a height has its building's.
      const TopHeight top = tagged_top(*part->area, site_.rule, part_file).value_or(own);
      const auto prisms =
          prisms_of(*part, bottom_m(*part->area, top.top_m, site_.rule, part_file), top.top_m);
      part_prisms.insert(part_prisms.end(), prisms.begin(), prisms.end());
      part_areas.resize(part_prisms.size(), part->area);
      if (top.top_m > highest_m) {
        highest_m = top.top_m;
        highest_source = top.source;
      }
    }
    UnitedPrisms united = unite_parts(outline_prisms, part_prisms);
    for (const std::size_t hidden : united.hidden_parts) {
      const AreaRecord& part = *part_areas[hidden];
      report_.files[part.file].add(Problem::kHiddenPart, part.object);
    }
    for (Prism& prism : united.prisms) {
      prism.bottom_m += base_m;
      prism.top_m += base_m;
    }
    Building building;
    building.osm_id = area.object.type == ObjectType::kRelation ? -area.object.id : area.object.id;
    building.name = area.tags["name"];
    building.prisms = std::move(united.prisms);
    building.outer_walls = walls_of(outline, parts);
    building.room_m = site_.rule.room_m;
    building.height_source = highest_m >= own.top_m ? highest_source : own.source;
    note(outline, building, base_m);
    return building;
  }

 private:
  static std::vector<Prism> prisms_of(const Shape& shape, double bottom, double top) {
    std::vector<Prism> prisms;
    for (const Footprint& footprint : shape.footprints) {
      prisms.push_back({.footprint = footprint, .bottom_m = bottom, .top_m = top});
    }
    return prisms;
  }

  /// The lowest ground at any corner, from which OpenStreetMap counts heights.
  [[nodiscard]] double ground_under(const Shape& outline,
                                    const std::vector<const Shape*>& parts) const {
    if (!site_.terrain) {
      return 0.0;
    }
    double lowest_m = std::numeric_limits<double>::max();
    const auto look = [&](const Shape& shape) {
      for (const Footprint& footprint : shape.footprints) {
        for (const auto& corner : footprint.outer) {
          lowest_m = std::min(lowest_m, site_.ground_m(corner));
        }
      }
    };
    look(outline);
    std::ranges::for_each(parts, [&](const Shape* part) { look(*part); });
    return lowest_m;
  }

  /// Of the outline, else of the largest part that has a known one, else the rule's.
  [[nodiscard]] Material walls_of(const Shape& outline, const std::vector<const Shape*>& parts) {
    if (const auto walls = known_walls(*outline.area)) {
      return *walls;
    }
    std::optional<Material> best;
    double largest_m2 = 0.0;
    for (const Shape* part : parts) {
      const auto walls = known_walls(*part->area);
      if (walls && area_m2(*part) > largest_m2) {
        largest_m2 = area_m2(*part);
        best = walls;
      }
    }
    return best.value_or(site_.rule.outer_walls);
  }

  std::optional<Material> known_walls(const AreaRecord& area) {
    const std::string_view text = material_tag(area);
    if (text.empty()) {
      return std::nullopt;
    }
    const auto walls = parse_material(text);
    if (!walls) {
      report_.files[area.file].add(Problem::kUnknownMaterial, area.object, text);
    }
    return walls;
  }

  void note(const Shape& outline, const Building& building, double base_m) {
    CityFigures& figures = report_.figures;
    ++figures.buildings;
    figures.prisms += building.prisms.size();
    figures.footprint_m2 += area_m2(outline);
    double top_m = 0.0;
    for (const Prism& prism : building.prisms) {
      top_m = std::max(top_m, prism.top_m - base_m);
    }
    figures.mean_height_m +=
        (top_m - figures.mean_height_m) / static_cast<double>(figures.buildings);
    if (top_m > figures.tallest_m) {
      figures.tallest_m = top_m;
      figures.tallest_osm_id = building.osm_id;
      figures.tallest_name = building.name;
    }
    ++(building.height_source == HeightSource::kTag      ? figures.height_from_tag
       : building.height_source == HeightSource::kLevels ? figures.height_from_levels
                                                         : figures.height_from_rule);
  }

  const Site& site_;
  ImportReport& report_;
};

std::vector<Shape> shapes_of(const std::vector<AreaRecord>& areas, AreaKind kind, const Site& site,
                             ImportReport& report) {
  std::vector<Shape> shapes;
  for (const AreaRecord& area : areas) {
    if (area.kind != kind) {
      continue;
    }
    ++(kind == AreaKind::kPart ? report.figures.part_areas : report.figures.building_areas);
    if (is_under_ground(area)) {
      report.files[area.file].add(Problem::kUnderGround, area.object);
      continue;
    }
    if (auto footprints = footprints_of(area, site, report); !footprints.empty()) {
      shapes.push_back({&area, std::move(footprints)});
    }
  }
  return shapes;
}

}  // namespace

bool is_under_ground(const AreaRecord& area) {
  return area.tags["location"] == "underground" || area.tags["layer"].starts_with('-');
}

std::vector<Building> build_buildings(const std::vector<AreaRecord>& areas, const Site& site,
                                      ImportReport& report) {
  const std::vector<Shape> outlines = shapes_of(areas, AreaKind::kBuilding, site, report);
  const std::vector<Shape> parts = shapes_of(areas, AreaKind::kPart, site, report);
  const OutlineIndex index{outlines};
  std::vector<std::vector<const Shape*>> parts_of(outlines.size());
  std::vector<const Shape*> alone;
  for (const Shape& part : parts) {
    if (const auto owner = index.owner_of(part)) {
      parts_of[*owner].push_back(&part);
    } else {
      report.files[part.area->file].add(Problem::kPartAlone, part.area->object);
      alone.push_back(&part);
    }
  }
  Builder builder{site, report};
  std::vector<Building> buildings;
  buildings.reserve(outlines.size() + alone.size());
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    buildings.push_back(builder.build(outlines[i], parts_of[i]));
  }
  for (const Shape* part : alone) {
    buildings.push_back(builder.build(*part, {}));
  }
  return buildings;
}

}  // namespace cuscus::city
