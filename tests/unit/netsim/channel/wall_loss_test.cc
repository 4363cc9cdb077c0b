#include "netsim/channel/wall_loss.h"

#include <catch2/catch.hpp>

namespace cuscus::netsim {
namespace {

constexpr double kCarrier_hz = 2.437e9;
constexpr SlabMaterial kConcrete{5.24, 0.0, 0.0462, 0.7822};
constexpr SlabMaterial kBrick{3.91, 0.0, 0.0238, 0.16};
constexpr SlabMaterial kGlass{6.31, 0.0, 0.0036, 1.3394};
constexpr SlabMaterial kWood{1.99, 0.0, 0.0047, 1.0718};
constexpr SlabMaterial kMarble{7.074, 0.0, 0.0055, 0.9262};
constexpr SlabMaterial kPlasterboard{2.73, 0.0, 0.0085, 0.9395};

// Worked out apart from this code with the constants of ITU-R P.2040-3, table 3, to 0.1 dB.
TEST_CASE("slabs lose what ITU-R P.2040 says") {
  struct Row {
    SlabMaterial material;
    double thickness_m;
    double loss_db;
  };
  for (const Row& row :
       {Row{kConcrete, 0.10, 8.1}, Row{kConcrete, 0.15, 11.5}, Row{kConcrete, 0.20, 14.7},
        Row{kConcrete, 0.30, 21.3}, Row{kBrick, 0.10, 3.2}, Row{kBrick, 0.20, 5.8},
        Row{kBrick, 0.36, 9.3}, Row{kGlass, 0.006, 1.9}, Row{kGlass, 0.012, 3.3},
        Row{kPlasterboard, 0.0125, 1.1}, Row{kWood, 0.03, 0.7}, Row{kMarble, 0.03, 2.9}}) {
    CAPTURE(row.thickness_m, row.loss_db);
    CHECK(slab_loss(row.material, row.thickness_m, kCarrier_hz).value ==
          Approx(row.loss_db).margin(0.051));
  }
  CHECK(slab_loss(kConcrete, 0.20, 5.18e9).value == Approx(25.3).margin(0.051));
}

TEST_CASE("no wall is no loss") {
  CHECK(slab_loss(kConcrete, 0.0, kCarrier_hz).value == Approx(0.0).margin(1e-12));
}

TEST_CASE("the paper's walls are the paper's, and nobody's gain") {
  const WallLosses walls = paper_walls(kCarrier_hz);
  CHECK(walls.outer[static_cast<std::size_t>(city::Material::kStone)].value == 12.0);
  CHECK(walls.outer[static_cast<std::size_t>(city::Material::kConcrete)].value == 15.0);
  for (const double carrier_hz : {0.9e9, 2.437e9, 5.18e9, 5.9e9}) {
    for (const WallLosses& losses : {paper_walls(carrier_hz), p2040_walls(carrier_hz)}) {
      CHECK(losses.inner.value > 0.0);
      for (const Decibel loss : losses.outer) {
        CHECK(loss.value > 0.0);
        CHECK(loss.value <= 100.0);
      }
    }
  }
}

// 35 (1 - exp(-d 0.36 / 35)): 10 m 3.4 dB, 50 m 14.1 dB, 100 m 22.5 dB.
TEST_CASE("leaves take less and less per metre, up to what goes around the wood") {
  CHECK(foliage_loss(0.0, 2.4e9).value == 0.0);
  CHECK(foliage_loss(10.0, 2.4e9).value == Approx(3.42).margin(0.01));
  CHECK(foliage_loss(50.0, 2.4e9).value == Approx(14.07).margin(0.01));
  CHECK(foliage_loss(100.0, 2.4e9).value == Approx(22.49).margin(0.01));
  CHECK(foliage_loss(1e5, 2.4e9).value == Approx(35.0));
  CHECK(foliage_loss(1.0, 0.5e9).value == Approx(0.17).margin(0.001));
  // Half-way between two rows of the table.
  CHECK(foliage_loss(1e5, 1.9845e9).value == Approx(31.55).margin(0.001));
}

}  // namespace
}  // namespace cuscus::netsim
