#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/scenario/names.h"
#include "common/scenario/scenario_error.h"
#include "common/scenario/units.h"

namespace cuscus::scenario {

/// Collects what is wrong, so that a user sees all of it at once.
class Problems {
 public:
  /// `overrides`: JSON pointers that options have set, and those options.
  Problems(std::string source, std::vector<std::pair<std::string, std::string>> overrides)
      : source_{std::move(source)}, overrides_{std::move(overrides)} {}

  /// Names the option instead of the file when it set what is at `path` or around it.
  void add(const std::string& path, const std::string& message);

  [[nodiscard]] bool empty() const noexcept { return problems_.empty(); }
  /// @throws ScenarioError when there is any.
  void throw_if_any() const;

 private:
  std::string source_;
  std::vector<std::pair<std::string, std::string>> overrides_;
  std::vector<Problem> problems_;
};

/// Limits of a quantity, written as a scenario writes them: {kTime, "1 ms", "10 s"}.
struct QuantityRange {
  const Dimension& dimension;
  std::string_view least;
  std::string_view most;
};

template <typename Number>
struct NumberRange {
  Number least;
  Number most;
};

/// `value` as JSON, shortened to fit in a message.
[[nodiscard]] std::string shown(const nlohmann::json& value);

/// Reads one object of a scenario: each getter takes a key's value, or `fallback` when it is absent
/// or wrong; what is wrong goes to `problems` with its path. finish() then finds the keys that no
/// getter asked for.
class ObjectReader {
 public:
  /// `value` may be null for an absent object, whose keys all have their defaults.
  ObjectReader(const nlohmann::json* value, std::string path, Problems& problems);

  /// The value of `key`, or null when it is absent.
  [[nodiscard]] const nlohmann::json* child(const std::string& key);

  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback,
                                 std::size_t longest_bytes);
  [[nodiscard]] bool boolean(const std::string& key, bool fallback);
  template <typename Integer>
  [[nodiscard]] Integer integer(const std::string& key, Integer fallback,
                                const NumberRange<Integer>& range) {
    return static_cast<Integer>(unsigned_integer(key, fallback, range.least, range.most));
  }
  [[nodiscard]] double number(const std::string& key, double fallback,
                              const NumberRange<double>& range);
  [[nodiscard]] double quantity(const std::string& key, double fallback,
                                const QuantityRange& range);
  [[nodiscard]] Duration duration(const std::string& key, Duration fallback, std::string_view least,
                                  std::string_view most);
  /// The period [ns] of a rate in Hz.
  [[nodiscard]] Duration period_of_rate(const std::string& key, Duration fallback,
                                        std::string_view least, std::string_view most);
  /// As many lengths as `fallback` has.
  template <std::size_t n>
  [[nodiscard]] std::array<double, n> lengths(const std::string& key,
                                              const std::array<double, n>& fallback) {
    std::array<double, n> result = fallback;
    read_lengths(key, result);
    return result;
  }
  [[nodiscard]] std::vector<std::string> texts(const std::string& key, std::size_t most_elements,
                                               std::size_t longest_bytes);

  template <typename Enum, std::size_t n>
  [[nodiscard]] Enum choice(const std::string& key, Enum fallback,
                            const std::array<Named<Enum>, n>& table) {
    std::vector<std::string> names;
    names.reserve(n);
    for (const auto& [name, value] : table) {
      names.emplace_back(name);
    }
    const std::size_t index = choice_index(key, names);
    return index < n ? table[index].second : fallback;
  }
  /// Index of the key's text in `names`; names.size() when absent or wrong.
  [[nodiscard]] std::size_t choice_index(const std::string& key,
                                         const std::vector<std::string>& names);

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] std::string path_of(const std::string& key) const;
  [[nodiscard]] Problems& problems() { return problems_; }
  /// Adds a problem with the value of `key`.
  void problem(const std::string& key, const std::string& message);
  void missing(const std::string& key, const std::string& allowed);
  void finish();

 private:
  [[nodiscard]] std::uint64_t unsigned_integer(const std::string& key, std::uint64_t fallback,
                                               std::uint64_t least, std::uint64_t most);
  void read_lengths(const std::string& key, std::span<double> lengths);

  const nlohmann::json* value_;
  std::string path_;
  Problems& problems_;
  std::vector<std::string> known_;
};

/// Whether `value` is the text "none"; any other text is a problem, and counts as none.
[[nodiscard]] bool is_none(const nlohmann::json* value, const std::string& path,
                           const std::string& otherwise, Problems& problems);

/// Reads the quantity `value` at `path`, or gives `fallback` and adds a problem.
[[nodiscard]] double read_quantity(const nlohmann::json& value, const std::string& path,
                                   double fallback, const QuantityRange& range, Problems& problems);

/// Reads the text `value` at `path`, or gives `fallback` and adds a problem.
[[nodiscard]] std::string read_text(const nlohmann::json& value, const std::string& path,
                                    const std::string& fallback, std::size_t longest_bytes,
                                    Problems& problems);

}  // namespace cuscus::scenario
