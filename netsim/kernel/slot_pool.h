#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cuscus::netsim {

/// Things known by number. Numbers, and the memory behind them, are used again. References last
/// until the next take().
template <typename T>
class SlotPool {
 public:
  /// A number that nobody has; its thing is as it was given back.
  [[nodiscard]] std::uint32_t take() {
    if (free_.empty()) {
      slots_.emplace_back();
      return static_cast<std::uint32_t>(slots_.size() - 1);
    }
    const std::uint32_t number = free_.back();
    free_.pop_back();
    return number;
  }
  void give_back(std::uint32_t number) { free_.push_back(number); }

  [[nodiscard]] T& operator[](std::uint32_t number) { return slots_[number]; }
  [[nodiscard]] const T& operator[](std::uint32_t number) const { return slots_[number]; }
  [[nodiscard]] std::size_t in_use() const { return slots_.size() - free_.size(); }

  // Over all that there ever were.
  [[nodiscard]] auto begin() const { return slots_.begin(); }
  [[nodiscard]] auto end() const { return slots_.end(); }

 private:
  std::vector<T> slots_;
  std::vector<std::uint32_t> free_;
};

}  // namespace cuscus::netsim
