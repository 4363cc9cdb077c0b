#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

/// A copy of a frame that is due at a receiver.
struct DueCopy {
  std::uint32_t frame;
  std::uint32_t receiver;
  SimTime due;
};

/// Copies that wait to be written, the one that is due first in front; of equal times, the one that
/// was added first.
class DueCopies {
 public:
  void add(const DueCopy& copy) {
    if (copies_.empty() || copies_.back().due <= copy.due) {
      copies_.push_back(copy);
      return;
    }
    // Its payload came late.
    const auto place =
        std::upper_bound(copies_.begin(), copies_.end(), copy.due,
                         [](SimTime due, const DueCopy& other) { return due < other.due; });
    copies_.insert(place, copy);
  }

  [[nodiscard]] bool empty() const { return copies_.empty(); }

  /// There must be one.
  [[nodiscard]] DueCopy take_first() {
    const DueCopy first = copies_.front();
    copies_.pop_front();
    return first;
  }

 private:
  std::deque<DueCopy> copies_;
};

}  // namespace cuscus::netsim
