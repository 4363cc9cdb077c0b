#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace cuscus::shm {

/// A value that one process writes and any number read, in shared memory, without a lock.
///
/// The writer never waits. A reader gets a value that was written as a whole, or nothing when the
/// writer kept changing it or died half-way: it can be delayed by a hostile writer, never held.
///
/// Source: H.-J. Boehm, "Can seqlocks get along with programming language memory models?",
/// MSPC 2012, section 4. The payload is stored with release and loaded with acquire order instead
/// of between fences, which costs nothing on x86 and is visible to ThreadSanitizer.
template <typename T>
class Seqlock {
  static_assert(std::is_trivially_copyable_v<T>, "shared memory holds plain data");
  static_assert(sizeof(T) % sizeof(std::uint64_t) == 0, "pad the value to whole words");
  static constexpr std::size_t kWords = sizeof(T) / sizeof(std::uint64_t);

 public:
  /// Publishes `value`. One writer at a time.
  void store(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words;
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t before = version_.load(std::memory_order_relaxed);
    version_.store(before + 1, std::memory_order_relaxed);  // odd: being written
    for (std::size_t i = 0; i < kWords; ++i) {
      words_[i].store(words[i], std::memory_order_release);
    }
    version_.store(before + 2, std::memory_order_release);
  }

  /// The latest value, or nothing after `attempts` reads that a write disturbed.
  [[nodiscard]] std::optional<T> load(int attempts = 64) const noexcept {
    std::array<std::uint64_t, kWords> words;
    while (attempts-- > 0) {
      const std::uint64_t before = version_.load(std::memory_order_acquire);
      if (before % 2 != 0) {
        continue;
      }
      for (std::size_t i = 0; i < kWords; ++i) {
        words[i] = words_[i].load(std::memory_order_acquire);
      }
      if (version_.load(std::memory_order_relaxed) == before) {
        T value;
        std::memcpy(&value, words.data(), sizeof value);
        return value;
      }
    }
    return std::nullopt;
  }

  /// How many values have been published; a reader compares it to see whether there is a new one.
  [[nodiscard]] std::uint64_t version() const noexcept {
    return version_.load(std::memory_order_acquire) / 2;
  }

 private:
  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace cuscus::shm
