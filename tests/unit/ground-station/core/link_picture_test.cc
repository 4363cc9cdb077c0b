#include "ground-station/core/link_picture.h"

#include <catch2/catch.hpp>
#include <limits>

namespace cuscus::gcs {
namespace {

constexpr SimTime after_ms(std::int64_t ms) { return sim_time(ms * 1'000'000); }

Observation heard(std::vector<Observation::Link> links) {
  Observation observation;
  observation.links = std::move(links);
  return observation;
}

TEST_CASE("links are those heard within the last second, one per pair, strongest first") {
  const Observation observation = heard({
      {.sender = 0,
       .receiver = 1,
       .received_dbm = -70.0F,
       .rate_kbps = 6'000,
       .heard = after_ms(4999)},  // too old
      {.sender = 1,
       .receiver = 0,
       .received_dbm = -80.0F,
       .rate_kbps = 6'000,
       .heard = after_ms(5000)},
      {.sender = 2,
       .receiver = 0,
       .received_dbm = -60.0F,
       .rate_kbps = 54'000,
       .heard = after_ms(6001)},  // just read
      {.sender = 0,
       .receiver = 2,
       .received_dbm = -62.0F,
       .rate_kbps = 6'000,
       .heard = after_ms(5900)},
      {.sender = 3,
       .receiver = 2,
       .received_dbm = -std::numeric_limits<float>::infinity(),
       .rate_kbps = 6'000,
       .heard = after_ms(6000)},
      {.sender = 1,
       .receiver = 2,
       .received_dbm = -65.0F,
       .rate_kbps = 6'000,
       .heard = after_ms(5500)},
  });

  const LinkPicture all = link_picture(observation, after_ms(6000), 10);

  CHECK(all.left_out == 0);
  REQUIRE(all.strongest.size() == 3);
  CHECK(all.strongest[0].a == 0);
  CHECK(all.strongest[0].b == 2);
  CHECK(all.strongest[0].received_dbm == -62.0);  // the weaker way
  CHECK(all.strongest[0].rate_kbps == 6'000);     // the slower way
  CHECK(all.strongest[0].age == SimClock::duration{0});
  CHECK_FALSE(all.strongest[0].one_way);
  CHECK(all.strongest[1].a == 1);
  CHECK(all.strongest[1].b == 2);
  CHECK(all.strongest[1].age == std::chrono::milliseconds{500});
  CHECK(all.strongest[1].one_way);
  CHECK(all.strongest[2].received_dbm == -80.0);
}

TEST_CASE("pairs beyond the most are left out whole, and what a node hears is not cut") {
  std::vector<Observation::Link> links;
  for (const std::uint32_t receiver : {0U, 1U, 2U}) {
    for (const std::uint32_t sender : {0U, 1U, 2U}) {
      if (sender != receiver) {
        // The way back is weaker than the way there: cut by ways, some pairs would lose one.
        const float level_dbm = receiver < sender ? -50.0F : -90.0F;
        links.push_back({.sender = sender,
                         .receiver = receiver,
                         .received_dbm = level_dbm,
                         .rate_kbps = 6'000,
                         .heard = after_ms(1000)});
      }
    }
  }

  const LinkPicture one = link_picture(heard(links), after_ms(1000), 1);

  REQUIRE(one.strongest.size() == 1);
  CHECK_FALSE(one.strongest[0].one_way);
  CHECK(one.left_out == 2);
  CHECK(one.hears == std::vector<std::uint32_t>{2, 2, 2});
}

TEST_CASE("a link to a node that never had anything to send is not called one-way") {
  Observation observation = heard({
      {.sender = 0,
       .receiver = 1,
       .received_dbm = -70.0F,
       .rate_kbps = 6'000,
       .heard = after_ms(1000)},
      {.sender = 0,
       .receiver = 2,
       .received_dbm = -75.0F,
       .rate_kbps = 6'000,
       .heard = after_ms(1000)},
  });
  observation.tallies.resize(3, shm::RadioTally{});
  observation.tallies[2]->offered = 1;

  const LinkPicture picture = link_picture(observation, after_ms(1000), 10);

  REQUIRE(picture.strongest.size() == 2);
  CHECK_FALSE(picture.strongest[0].one_way);  // node 1 is silent
  CHECK(picture.strongest[1].one_way);        // node 2 is not, and is not heard
}

TEST_CASE("nothing heard is an empty picture") {
  const LinkPicture picture = link_picture({}, after_ms(1000), 10);

  CHECK(picture.strongest.empty());
  CHECK(picture.left_out == 0);
  CHECK(picture.hears.empty());
}

}  // namespace
}  // namespace cuscus::gcs
