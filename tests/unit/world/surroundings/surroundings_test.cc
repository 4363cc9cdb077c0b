#include "world/surroundings/surroundings.h"

#include <catch2/catch.hpp>

#include "common/random/counter_stream.h"

namespace cuscus::world {
namespace {

/// Number `index` of points spread over a cube around the origin, some below the ground.
Eigen::Vector3d point(std::uint64_t index) {
  const random::CounterStream stream{3, 0};
  return {20.0 * stream.uniform(3 * index) - 10.0, 20.0 * stream.uniform(3 * index + 1) - 10.0,
          20.0 * stream.uniform(3 * index + 2) - 2.0};
}

TEST_CASE("the bare ground answers as a city with nothing in it") {
  const city::CityGeometry empty{city::City{}};
  const Surroundings bare;
  const Surroundings city{&empty};

  for (std::uint64_t k = 0; k < 2000; ++k) {
    const Eigen::Vector3d p = point(2 * k);
    const Eigen::Vector3d q = point(2 * k + 1);
    CAPTURE(p.transpose(), q.transpose());

    const auto hit = bare.first_hit(p, q - p, 8.0);
    const auto city_hit = city.first_hit(p, q - p, 8.0);
    REQUIRE(hit.has_value() == city_hit.has_value());
    if (hit) {
      CHECK(hit->distance_m == Approx(city_hit->distance_m).margin(1e-9));
      CHECK(hit->normal.isApprox(city_hit->normal, 1e-9));
    }
    const auto nearest = bare.nearest(p, 5.0);
    const auto city_nearest = city.nearest(p, 5.0);
    REQUIRE(nearest.has_value() == city_nearest.has_value());
    if (nearest) {
      CHECK(nearest->distance_m == Approx(city_nearest->distance_m).margin(1e-9));
      CHECK((nearest->p_WS - city_nearest->p_WS).norm() < 1e-9);
    }
    const auto contact = bare.sweep(p, q, 0.3);
    const auto city_contact = city.sweep(p, q, 0.3);
    REQUIRE(contact.has_value() == city_contact.has_value());
    if (contact) {
      CHECK(contact->t == Approx(city_contact->t).margin(1e-9));
      CHECK(contact->normal.isApprox(city_contact->normal, 1e-9));
    }
  }
}

}  // namespace
}  // namespace cuscus::world
