#include "common/city/export/names.h"

namespace cuscus::city {

const char* name_of(Material material) {
  switch (material) {
    case Material::kStone:
      return "stone";
    case Material::kConcrete:
      return "concrete";
    case Material::kBrick:
      return "brick";
    case Material::kGlass:
      return "glass";
    case Material::kMetal:
      return "metal";
    case Material::kWood:
      return "wood";
  }
  return "";
}

const char* name_of(HeightSource source) {
  switch (source) {
    case HeightSource::kTag:
      return "tag";
    case HeightSource::kLevels:
      return "levels";
    case HeightSource::kRule:
      return "rule";
  }
  return "";
}

}  // namespace cuscus::city
