#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "common/city/city.h"

namespace cuscus::city {

inline constexpr std::array<std::pair<std::string_view, Material>, kMaterials> kMaterialNames{
    {{"stone", Material::kStone},
     {"concrete", Material::kConcrete},
     {"brick", Material::kBrick},
     {"glass", Material::kGlass},
     {"metal", Material::kMetal},
     {"wood", Material::kWood}}};

inline constexpr std::array<std::pair<std::string_view, HeightSource>, 3> kHeightSourceNames{
    {{"tag", HeightSource::kTag},
     {"levels", HeightSource::kLevels},
     {"rule", HeightSource::kRule}}};

/// Both tables are in the order of their enumerators.
[[nodiscard]] constexpr std::string_view name_of(Material material) {
  return kMaterialNames[static_cast<std::size_t>(material)].first;
}
[[nodiscard]] constexpr std::string_view name_of(HeightSource source) {
  return kHeightSourceNames[static_cast<std::size_t>(source)].first;
}

}  // namespace cuscus::city
