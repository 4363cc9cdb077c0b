#include "netsim/channel/wall_loss.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "common/units/constants.h"

namespace cuscus::netsim {
namespace {

using std::numbers::pi;

constexpr SlabMaterial kConcrete{5.24, 0.0, 0.0462, 0.7822};
constexpr SlabMaterial kBrick{3.91, 0.0, 0.0238, 0.16};
constexpr SlabMaterial kPlasterboard{2.73, 0.0, 0.0085, 0.9395};
constexpr SlabMaterial kWood{1.99, 0.0, 0.0047, 1.0718};
constexpr SlabMaterial kGlass{6.31, 0.0, 0.0036, 1.3394};
constexpr SlabMaterial kMarble{7.074, 0.0, 0.0055, 0.9262};
constexpr Decibel kMetal{60.0};
constexpr double kHertzPerGigahertz = 1e9;

Decibel& of(WallLosses& walls, city::Material material) {
  return walls.outer[static_cast<std::size_t>(material)];
}

struct FoliageConstants {
  double frequency_ghz;
  double specific_dbpm;
  double greatest_db;
};
constexpr std::array<FoliageConstants, 4> kMixedForest{
    {{0.949, 0.17, 26.5}, {1.852, 0.30, 29.0}, {2.117, 0.34, 34.1}, {2.4, 0.36, 35.0}}};

FoliageConstants foliage_at(double frequency_ghz) {
  if (frequency_ghz <= kMixedForest.front().frequency_ghz) {
    return kMixedForest.front();
  }
  for (std::size_t i = 1; i < kMixedForest.size(); ++i) {
    const FoliageConstants& low = kMixedForest[i - 1];
    const FoliageConstants& high = kMixedForest[i];
    if (frequency_ghz <= high.frequency_ghz) {
      const double share =
          (frequency_ghz - low.frequency_ghz) / (high.frequency_ghz - low.frequency_ghz);
      return {frequency_ghz, std::lerp(low.specific_dbpm, high.specific_dbpm, share),
              std::lerp(low.greatest_db, high.greatest_db, share)};
    }
  }
  return kMixedForest.back();
}

}  // namespace

Decibel slab_loss(const SlabMaterial& material, double thickness_m, double carrier_hz) {
  constexpr double kConductivityFactor = 17.98;  // 1 / (2 pi epsilon_0), in S/m and GHz
  const double f_ghz = carrier_hz / kHertzPerGigahertz;
  const std::complex<double> permittivity{
      material.a * std::pow(f_ghz, material.b),
      -kConductivityFactor * material.c * std::pow(f_ghz, material.d) / f_ghz};
  const std::complex<double> index = std::sqrt(permittivity);
  const std::complex<double> reflected = (1.0 - index) / (1.0 + index);
  const std::complex<double> phase = std::exp(
      std::complex<double>{0.0, -2.0 * pi * thickness_m * carrier_hz / kSpeedOfLight_mps} * index);
  const std::complex<double> passed =
      (1.0 - reflected * reflected) * phase / (1.0 - reflected * reflected * phase * phase);
  return {-20.0 * std::log10(std::abs(passed))};
}

WallLosses p2040_walls(double carrier_hz) {
  WallLosses walls;
  of(walls, city::Material::kStone) = slab_loss(kMarble, 0.4, carrier_hz);
  of(walls, city::Material::kConcrete) = slab_loss(kConcrete, 0.2, carrier_hz);
  of(walls, city::Material::kBrick) = slab_loss(kBrick, 0.36, carrier_hz);
  of(walls, city::Material::kGlass) = slab_loss(kGlass, 0.012, carrier_hz);
  of(walls, city::Material::kMetal) = kMetal;
  of(walls, city::Material::kWood) = slab_loss(kWood, 0.1, carrier_hz);
  walls.inner = {2.0 * slab_loss(kPlasterboard, 0.0125, carrier_hz).value};
  return walls;
}

WallLosses paper_walls(double carrier_hz) {
  WallLosses walls = p2040_walls(carrier_hz);
  of(walls, city::Material::kStone) = {12.0};
  of(walls, city::Material::kConcrete) = {15.0};
  of(walls, city::Material::kGlass) = {7.0};
  of(walls, city::Material::kWood) = {4.0};
  walls.inner = {5.0};
  return walls;
}

Decibel foliage_loss(double length_m, double carrier_hz) {
  const FoliageConstants at = foliage_at(carrier_hz / kHertzPerGigahertz);
  return {at.greatest_db * -std::expm1(-length_m * at.specific_dbpm / at.greatest_db)};
}

}  // namespace cuscus::netsim
