#pragma once

#include <string>
#include <string_view>

namespace cuscus::orchestrator {

/// Looks at the pieces of an answer as they pass: do they make a whole OSM file?
class MapCheck {
 public:
  void take(std::string_view piece);

  /// What is wrong with the answer, once all of it has passed; empty: nothing.
  [[nodiscard]] std::string fault() const;

 private:
  std::string head_;
  std::string tail_;
};

}  // namespace cuscus::orchestrator
