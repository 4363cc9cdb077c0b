#include "netsim/kernel/event_queue.h"

#include <catch2/catch.hpp>
#include <string>

namespace cuscus::netsim {
namespace {

std::string order_of(EventQueue<char>& queue) {
  std::string order;
  while (!queue.empty()) {
    order += queue.pop().payload;
  }
  return order;
}

TEST_CASE("events come by time, then rank, then in the order of their scheduling") {
  EventQueue<char> queue;
  queue.schedule(sim_time(20), 0, 'f');
  queue.schedule(sim_time(10), 2, 'd');
  queue.schedule(sim_time(10), 1, 'b');
  queue.schedule(sim_time(10), 2, 'e');
  queue.schedule(sim_time(10), 1, 'c');
  queue.schedule(sim_time(5), 9, 'a');

  CHECK(queue.next_time() == sim_time(5));
  CHECK(order_of(queue) == "abcdef");
}

TEST_CASE("a cancelled event does not come, and next_time skips it") {
  EventQueue<char> queue;
  const EventId first = queue.schedule(sim_time(1), 0, 'x');
  queue.schedule(sim_time(2), 0, 'a');
  const EventId later = queue.schedule(sim_time(3), 0, 'y');

  queue.cancel(first);
  queue.cancel(later);

  CHECK(queue.size() == 1);
  CHECK(queue.next_time() == sim_time(2));
  CHECK(order_of(queue) == "a");
}

TEST_CASE("cancelling what has run does not touch the event that took its place") {
  EventQueue<char> queue;
  const EventId old = queue.schedule(sim_time(1), 0, 'a');
  CHECK(queue.pop().payload == 'a');
  queue.schedule(sim_time(2), 0, 'b');

  queue.cancel(old);
  queue.cancel(EventId{});

  CHECK(order_of(queue) == "b");
}

}  // namespace
}  // namespace cuscus::netsim
