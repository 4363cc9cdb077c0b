#pragma once

#include <cmath>
#include <cstdint>

#include "common/random/counter_stream.h"

namespace cuscus::city::generate {

/// What a stream of random numbers is for. Never renumbered: a seed keeps its city.
enum class Purpose : std::uint16_t {
  kSites = 1,
  kStreets = 2,
  kNames = 3,
  kBlock = 4,
  kTrees = 5,
};

/// The draws of one stream, one after the other.
class Dice {
 public:
  Dice(std::uint64_t seed, Purpose purpose, std::size_t object = 0)
      : stream_{seed, random::stream_id(static_cast<std::uint16_t>(purpose),
                                        static_cast<std::uint32_t>(object))} {}

  [[nodiscard]] double uniform(double from, double to) {
    return from + (to - from) * stream_.uniform(next_++);
  }
  /// In whole steps of 0.1.
  [[nodiscard]] double tenths(double from, double to) {
    return std::round(uniform(from, to) * 10.0) / 10.0;
  }
  [[nodiscard]] bool chance(double probability) { return stream_.uniform(next_++) < probability; }
  [[nodiscard]] std::uint32_t below(std::uint32_t bound) { return stream_.below(next_++, bound); }

 private:
  random::CounterStream stream_;
  std::uint64_t next_{0};
};

}  // namespace cuscus::city::generate
