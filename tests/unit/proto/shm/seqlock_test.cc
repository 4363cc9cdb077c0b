#include "proto/shm/seqlock.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <thread>
#include <vector>

namespace cuscus::shm {
namespace {

/// Whole only if all words are equal.
struct Value {
  std::array<std::uint64_t, 24> words;
};

Value all(std::uint64_t word) {
  Value value{};
  value.words.fill(word);
  return value;
}

TEST_CASE("a seqlock gives back what was stored, zeroes before") {
  Seqlock<Value> lock;

  CHECK(lock.load()->words == all(0).words);
  lock.store(all(7));
  CHECK(lock.load()->words == all(7).words);
  CHECK(lock.version() == 1);
}

TEST_CASE("readers beside a writer see whole values, in order") {
  const auto lock = std::make_unique<Seqlock<Value>>();
  constexpr std::uint64_t kWrites = 200'000;
  std::atomic<bool> torn{false};
  std::atomic<bool> backwards{false};
  std::atomic<std::uint64_t> reads{0};

  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      while (last < kWrites) {
        const auto value = lock->load();
        if (!value) {
          continue;
        }
        for (const std::uint64_t word : value->words) {
          if (word != value->words[0]) {
            torn = true;
          }
        }
        if (value->words[0] < last) {
          backwards = true;
        }
        last = value->words[0];
        reads.fetch_add(1, std::memory_order_relaxed);
      }
    });
  }
  for (std::uint64_t i = 1; i <= kWrites; ++i) {
    lock->store(all(i));
  }
  for (auto& reader : readers) {
    reader.join();
  }

  CHECK_FALSE(torn);
  CHECK_FALSE(backwards);
  CHECK(reads >= 3);
}

}  // namespace
}  // namespace cuscus::shm
