#include "ground-station/core/sequence_tally.h"

#include <catch2/catch.hpp>

namespace cuscus::gcs {
namespace {

using Arrival = SequenceTally::Arrival;

TEST_CASE("gaps in a sequence are its loss") {
  SequenceTally tally;
  CHECK(tally.loss_ratio() == 0.0);

  for (const std::uint32_t sequence : {7U, 8U, 10U, 14U}) {
    CHECK(tally.count(sequence) == Arrival::kNewest);
  }

  CHECK(tally.received() == 4);
  CHECK(tally.expected() == 8);  // 7 ... 14
  CHECK(tally.loss_ratio() == 0.5);
  CHECK(tally.recent_loss_ratio() == 0.5);
}

TEST_CASE("what comes late fills its gap and what comes twice counts once") {
  SequenceTally tally;
  tally.count(1);
  tally.count(4);

  CHECK(tally.count(2) == Arrival::kLate);
  CHECK(tally.count(2) == Arrival::kDuplicate);
  CHECK(tally.count(4) == Arrival::kDuplicate);

  CHECK(tally.received() == 3);
  CHECK(tally.loss_ratio() == 0.25);
}

TEST_CASE("a late number from before the first one widens what is expected") {
  SequenceTally tally;
  tally.count(5);

  CHECK(tally.count(3) == Arrival::kLate);

  CHECK(tally.expected() == 3);  // 3, 4, 5
  CHECK(tally.received() == 2);
}

TEST_CASE("numbers wrap around") {
  SequenceTally tally;
  tally.count(0xFFFF'FFFEU);

  CHECK(tally.count(1) == Arrival::kNewest);
  CHECK(tally.expected() == 4);  // ...FE, ...FF, 0, 1
  CHECK(tally.count(0xFFFF'FFFFU) == Arrival::kLate);
}

TEST_CASE("a sender that begins anew gets a new tally") {
  SequenceTally tally;
  for (std::uint32_t sequence = 0; sequence < 200; sequence += 2) {
    tally.count(sequence);
  }

  CHECK(tally.count(0) == Arrival::kNewest);

  CHECK(tally.received() == 1);
  CHECK(tally.loss_ratio() == 0.0);
}

TEST_CASE("recent loss forgets what lies beyond its window") {
  SequenceTally tally;
  tally.count(0);
  tally.count(100);  // 99 lost
  for (std::uint32_t sequence = 101; sequence < 100 + SequenceTally::kWindow; ++sequence) {
    tally.count(sequence);
  }

  CHECK(tally.recent_loss_ratio() == 0.0);
  CHECK(tally.loss_ratio() == Approx(99.0 / 164.0));  // 0 ... 163

  tally.count(163 + 1000);  // a gap longer than the window
  CHECK(tally.recent_loss_ratio() == Approx(63.0 / 64.0));
}

}  // namespace
}  // namespace cuscus::gcs
