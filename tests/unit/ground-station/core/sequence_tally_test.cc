#include "ground-station/core/sequence_tally.h"

#include <catch2/catch.hpp>

namespace cuscus::gcs {
namespace {

using Arrival = SequenceTally::Arrival;

/// Of a sender that counts one per second and never began anew.
Arrival count(SequenceTally& tally, std::uint32_t sequence) {
  return tally.count(sequence, SimTime{std::chrono::seconds{static_cast<std::int32_t>(sequence)}});
}

TEST_CASE("gaps in a sequence are its loss") {
  SequenceTally tally;
  CHECK(tally.loss_ratio() == 0.0);

  for (const std::uint32_t sequence : {7U, 8U, 10U, 14U}) {
    CHECK(count(tally, sequence) == Arrival::kNewest);
  }

  CHECK(tally.received() == 4);
  CHECK(tally.expected() == 8);  // 7 ... 14
  CHECK(tally.loss_ratio() == 0.5);
  CHECK(tally.recent_loss_ratio() == 0.5);
}

TEST_CASE("what comes late fills its gap and what comes twice counts once") {
  SequenceTally tally;
  count(tally, 1);
  count(tally, 4);

  CHECK(count(tally, 2) == Arrival::kLate);
  CHECK(count(tally, 2) == Arrival::kDuplicate);
  CHECK(count(tally, 4) == Arrival::kDuplicate);

  CHECK(tally.received() == 3);
  CHECK(tally.loss_ratio() == 0.25);
}

TEST_CASE("a late number from before the first one widens what is expected") {
  SequenceTally tally;
  count(tally, 5);

  CHECK(count(tally, 3) == Arrival::kLate);

  CHECK(tally.expected() == 3);  // 3, 4, 5
  CHECK(tally.received() == 2);
}

TEST_CASE("numbers wrap around") {
  SequenceTally tally;
  count(tally, 0xFFFF'FFFEU);

  CHECK(count(tally, 1) == Arrival::kNewest);
  CHECK(tally.expected() == 4);  // ...FE, ...FF, 0, 1
  CHECK(count(tally, 0xFFFF'FFFFU) == Arrival::kLate);
}

TEST_CASE("a sender that begins anew gets a new tally") {
  SequenceTally tally;
  for (std::uint32_t sequence = 0; sequence < 200; sequence += 2) {
    count(tally, sequence);
  }

  CHECK(count(tally, 0) == Arrival::kNewest);

  CHECK(tally.received() == 1);
  CHECK(tally.loss_ratio() == 0.0);
}

TEST_CASE("an old number with a later time is of a sender that began anew") {
  SequenceTally tally;
  tally.count(1, SimTime{std::chrono::seconds{1}});
  tally.count(30, SimTime{std::chrono::seconds{30}});
  CHECK(tally.count(29, SimTime{std::chrono::seconds{29}}) == Arrival::kLate);
  CHECK(tally.count(30, SimTime{std::chrono::seconds{30}}) == Arrival::kDuplicate);

  CHECK(tally.count(1, SimTime{std::chrono::seconds{33}}) == Arrival::kNewest);
  CHECK(tally.count(2, SimTime{std::chrono::seconds{34}}) == Arrival::kNewest);

  CHECK(tally.received() == 2);
  CHECK(tally.expected() == 2);
}

TEST_CASE("recent loss forgets what lies beyond its window") {
  SequenceTally tally;
  count(tally, 0);
  count(tally, 100);  // 99 lost
  for (std::uint32_t sequence = 101; sequence < 100 + SequenceTally::kWindow; ++sequence) {
    count(tally, sequence);
  }

  CHECK(tally.recent_loss_ratio() == 0.0);
  CHECK(tally.loss_ratio() == Approx(99.0 / 164.0));  // 0 ... 163

  count(tally, 163 + 1000);  // a gap longer than the window
  CHECK(tally.recent_loss_ratio() == Approx(63.0 / 64.0));
}

}  // namespace
}  // namespace cuscus::gcs
