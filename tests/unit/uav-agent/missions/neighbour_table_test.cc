#include "uav-agent/missions/neighbour_table.h"

#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

namespace cuscus::missions {
namespace {

using Verdict = NeighbourTable::Verdict;

constexpr SimTime at(int milliseconds) { return SimTime{std::chrono::milliseconds{milliseconds}}; }

NeighbourReport report(std::uint32_t slot, std::uint32_t sequence, int milliseconds) {
  return {.slot = slot, .sequence = sequence, .time = at(milliseconds), .p_WB_m = {1.0, 2.0, 3.0}};
}

NeighbourTable table_of_slot_2() { return NeighbourTable{2, 5, std::chrono::seconds{1}}; }

TEST_CASE("a table keeps the newest report of each slot") {
  auto table = table_of_slot_2();

  CHECK(table.accept(report(1, 7, 100), at(110)) == Verdict::kAccepted);
  CHECK(table.accept(report(3, 1, 105), at(110)) == Verdict::kAccepted);
  CHECK(table.accept(report(1, 8, 150), at(160)) == Verdict::kAccepted);

  CHECK(table.heard(1, at(160)).value().sequence == 8);
  CHECK(table.heard(3, at(160)).value().sequence == 1);
  CHECK_FALSE(table.heard(0, at(160)));
  CHECK(table.heard_count(at(160)) == 2);
}

TEST_CASE("a table refuses what is old, repeated or overtaken") {
  auto table = table_of_slot_2();
  REQUIRE(table.accept(report(1, 7, 100), at(110)) == Verdict::kAccepted);

  CHECK(table.accept(report(1, 7, 100), at(111)) == Verdict::kOld);
  CHECK(table.accept(report(1, 6, 120), at(121)) == Verdict::kOld);
  CHECK(table.accept(report(1, 8, 90), at(121)) == Verdict::kOld);
  CHECK(table.heard(1, at(121)).value().time == at(100));
}

TEST_CASE("sequence numbers wrap round") {
  auto table = table_of_slot_2();
  const auto last = std::numeric_limits<std::uint32_t>::max();
  REQUIRE(table.accept(report(1, last, 100), at(100)) == Verdict::kAccepted);

  CHECK(table.accept(report(1, 0, 110), at(110)) == Verdict::kAccepted);
  CHECK(table.accept(report(1, last, 120), at(120)) == Verdict::kOld);
}

TEST_CASE("a table refuses senders and positions that cannot be") {
  auto table = table_of_slot_2();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();

  CHECK(table.accept(report(5, 1, 10), at(10)) == Verdict::kUnknown);
  CHECK(table.accept(report(0xffffffffU, 1, 10), at(10)) == Verdict::kUnknown);
  CHECK(table.accept(report(2, 1, 10), at(10)) == Verdict::kOwn);
  for (const double bad : {nan, infinity, -infinity, 1e6}) {
    auto broken = report(1, 1, 10);
    broken.p_WB_m.y() = bad;
    CHECK(table.accept(broken, at(10)) == Verdict::kMalformed);
  }
  CHECK(table.accept(report(1, 1, 1000), at(10)) == Verdict::kMalformed);
  CHECK(table.accept(report(1, 1, -1), at(10)) == Verdict::kMalformed);
  CHECK(table.heard_count(at(10)) == 0);
}

TEST_CASE("a silent neighbour is forgotten after the timeout, and heard again when it restarts") {
  auto table = table_of_slot_2();
  REQUIRE(table.accept(report(1, 900, 100), at(110)) == Verdict::kAccepted);

  CHECK(table.heard(1, at(1110)));
  CHECK_FALSE(table.heard(1, at(1111)));
  CHECK(table.accept(report(1, 1, 1200), at(1200)) == Verdict::kAccepted);
  CHECK(table.heard(1, at(1200)).value().sequence == 1);
}

TEST_CASE("a table needs an owner inside the fleet") {
  CHECK_THROWS_AS((NeighbourTable{5, 5, std::chrono::seconds{1}}), std::invalid_argument);
}

}  // namespace
}  // namespace cuscus::missions
