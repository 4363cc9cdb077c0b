#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "proto/reception_log.h"

namespace cuscus::orchestrator {

/// Reads a reception log record by record; it may be larger than memory.
class ReceptionLogReader {
 public:
  /// @throws std::runtime_error naming `file` and what is wrong with it.
  explicit ReceptionLogReader(const std::filesystem::path& file);

  /// Of the nodes, by number.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Nothing at the end. A record whose numbers cannot be is passed over.
  [[nodiscard]] std::optional<logs::ReceptionLogRecord> next();

 private:
  [[nodiscard]] bool fill();

  std::ifstream file_;
  std::vector<std::string> names_;
  std::vector<logs::ReceptionLogRecord> buffer_;
  std::size_t next_{0};
};

}  // namespace cuscus::orchestrator
