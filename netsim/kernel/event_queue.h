#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "common/units/sim_time.h"

namespace cuscus::netsim {

/// Names a scheduled event, so that it can be cancelled. Of an event that has run or was cancelled
/// it names nothing, and cancelling it again does nothing.
struct EventId {
  std::uint32_t slot{0xffffffffU};
  std::uint32_t generation{0};
};

/// Events in the order of their time; at one time, of their rank; at one rank, of their scheduling.
///
/// The rank makes ties mean something whatever order they were scheduled in, so that a run does not
/// depend on when its input became known. Payload is a small value that says what to do.
/// Not for use by several threads. Memory is reused: a queue in a steady state allocates nothing.
template <typename Payload>
class EventQueue {
 public:
  struct Event {
    SimTime time;
    std::uint64_t rank;
    Payload payload;
  };

  EventId schedule(SimTime time, std::uint64_t rank, const Payload& payload) {
    std::uint32_t slot = 0;
    if (free_.empty()) {
      slot = static_cast<std::uint32_t>(slots_.size());
      slots_.push_back({});
    } else {
      slot = free_.back();
      free_.pop_back();
    }
    slots_[slot].payload = payload;
    slots_[slot].pending = true;
    heap_.push_back({time, rank, sequence_++, slot});
    std::push_heap(heap_.begin(), heap_.end(), Later{});
    ++pending_;
    return {slot, slots_[slot].generation};
  }

  /// Takes an event back; nothing happens when it has run already.
  void cancel(EventId id) {
    if (id.slot < slots_.size() && slots_[id.slot].generation == id.generation &&
        slots_[id.slot].pending) {
      slots_[id.slot].pending = false;  // its heap entry is dropped when it comes up
      --pending_;
      discard_cancelled();
    }
  }

  [[nodiscard]] bool empty() const { return pending_ == 0; }
  [[nodiscard]] std::size_t size() const { return pending_; }

  /// Of the first event. Requires !empty().
  [[nodiscard]] SimTime next_time() const {
    assert(!empty());
    return heap_.front().time;
  }

  /// Removes the first event and returns it. Requires !empty().
  Event pop() {
    assert(!empty());
    const Entry entry = heap_.front();
    Event event{entry.time, entry.rank, slots_[entry.slot].payload};
    slots_[entry.slot].pending = false;
    --pending_;
    remove_front();
    discard_cancelled();
    return event;
  }

 private:
  struct Entry {
    SimTime time;
    std::uint64_t rank;
    std::uint64_t sequence;
    std::uint32_t slot;
  };
  struct Slot {
    Payload payload{};
    std::uint32_t generation{0};
    bool pending{false};
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const {
      if (a.time != b.time) {
        return a.time > b.time;
      }
      return a.rank != b.rank ? a.rank > b.rank : a.sequence > b.sequence;
    }
  };

  void remove_front() {
    const std::uint32_t slot = heap_.front().slot;
    std::pop_heap(heap_.begin(), heap_.end(), Later{});
    heap_.pop_back();
    ++slots_[slot].generation;
    free_.push_back(slot);
  }

  /// Keeps the invariant that the heap's front is pending.
  void discard_cancelled() {
    while (!heap_.empty() && !slots_[heap_.front().slot].pending) {
      remove_front();
    }
  }

  std::vector<Entry> heap_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
  std::uint64_t sequence_{0};
  std::size_t pending_{0};
};

}  // namespace cuscus::netsim
