#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cuscus::netsim {

/// A line of a CSV file, by column name; of columns with one name the first counts.
using CsvRow = std::map<std::string, std::string>;

/// All lines of a CSV file with a header.
inline std::vector<CsvRow> read_csv(const std::string& path) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream text{line};
    for (std::string field; std::getline(text, field, ',');) {
      fields.push_back(field);
    }
    return fields;
  };
  std::ifstream file{path};
  std::string line;
  if (!std::getline(file, line)) {
    throw std::runtime_error{"cannot read " + path};
  }
  const auto names = split(line);
  std::vector<CsvRow> rows;
  while (std::getline(file, line)) {
    const auto fields = split(line);
    CsvRow row;
    for (std::size_t i = 0; i < fields.size() && i < names.size(); ++i) {
      row.emplace(names[i], fields[i]);
    }
    rows.push_back(row);
  }
  return rows;
}

inline double number(const CsvRow& row, const std::string& column) {
  return std::stod(row.at(column));
}

}  // namespace cuscus::netsim
