#include "common/scenario/scenario_error.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cuscus::scenario {
namespace {

std::string text_of(const std::vector<Problem>& problems) {
  std::string text;
  const std::size_t shown = std::min(problems.size(), ScenarioError::kMaxProblems);
  for (std::size_t i = 0; i < shown; ++i) {
    const Problem& problem = problems[i];
    text += (text.empty() ? "" : "\n") + problem.source + ": " +
            (problem.path.empty() ? "" : problem.path + ": ") + problem.message;
  }
  if (shown < problems.size()) {
    text += "\nand " + std::to_string(problems.size() - shown) + " more";
  }
  return text;
}

/// Edits (insert, delete, replace one character) that turn `a` into `b` (Levenshtein, 1966).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

ScenarioError::ScenarioError(std::vector<Problem> problems)
    : std::runtime_error{text_of(problems)}, problems_{std::move(problems)} {}

std::string nearest(const std::string& given, const std::vector<std::string>& options) {
  constexpr std::size_t kLongest = 64;  // longer ones are not misspelt, and cost their square
  if (given.size() > kLongest) {
    return {};
  }
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, given.size() / 3) + 1;
  for (const std::string& option : options) {
    const std::size_t distance = edit_distance(given, option);
    if (distance < best_distance && distance < option.size()) {
      best = option;
      best_distance = distance;
    }
  }
  return best;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

}  // namespace cuscus::scenario
