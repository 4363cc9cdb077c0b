#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace cuscus::scenario {

/// One thing that is wrong with a scenario.
struct Problem {
  std::string source;   ///< The file, or the command-line option that set the value.
  std::string path;     ///< JSON pointer such as "/radio/data_rate"; empty: the whole document.
  std::string message;  ///< What was given and what is allowed.
};

/// A scenario that cannot be used. what() has one line per problem: "file: path: message".
class ScenarioError : public std::runtime_error {
 public:
  /// At most this many problems are listed.
  static constexpr std::size_t kMaxProblems = 20;

  /// `problems` is not empty.
  explicit ScenarioError(std::vector<Problem> problems);

  [[nodiscard]] const std::vector<Problem>& problems() const noexcept { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The option of `options` that is nearest to `given`, or empty when none is near.
[[nodiscard]] std::string nearest(const std::string& given,
                                  const std::vector<std::string>& options);

/// "a, b, c".
[[nodiscard]] std::string joined(const std::vector<std::string>& words);

}  // namespace cuscus::scenario
