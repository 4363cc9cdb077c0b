#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

using Table = std::vector<std::vector<double>>;

constexpr const char* kAllowedAntennas =
    "allowed: isotropic, dipole, or an object with either gains or file";
constexpr std::size_t kMostElevations = 361;
constexpr std::size_t kMostAzimuths = 720;
constexpr double kLeastGain_dBi = -100.0;
constexpr double kMostGain_dBi = 40.0;

/// What is wrong with a table whose missing and strange entries are NaN.
std::optional<std::string> fault_of(const Table& table) {
  if (table.size() < 2 || table.size() > kMostElevations) {
    return "has " + std::to_string(table.size()) + " rows; allowed: 2 ... 361";
  }
  const std::size_t azimuths = table.front().size();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const std::size_t numbers = table[row].size();
    const std::string name = "row " + std::to_string(row + 1);
    if (numbers != azimuths || numbers == 0 || numbers > kMostAzimuths) {
      return name + " has " + std::to_string(numbers) + " numbers and row 1 has " +
             std::to_string(azimuths) + "; allowed: 1 ... 720, as many in every row";
    }
    for (std::size_t i = 0; i < numbers; ++i) {
      if (!(table[row][i] >= kLeastGain_dBi && table[row][i] <= kMostGain_dBi)) {
        return name + ", number " + std::to_string(i + 1) +
               " is no gain; allowed: a number of dBi, -100 ... 40";
      }
    }
  }
  return std::nullopt;
}

Table table_of(const json& value) {
  Table table;
  for (const json& row : value) {
    std::vector<double>& gains = table.emplace_back();
    for (const json& gain : row.is_array() ? row : json::array({row})) {
      gains.push_back(row.is_array() && gain.is_number() ? gain.get<double>() : NAN);
    }
  }
  return table;
}

double gain_of(std::string_view text) {
  constexpr const char* kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return NAN;
  }
  text = text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
  text.remove_prefix(text.front() == '+' ? 1 : 0);
  double gain = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), gain);
  return error == std::errc{} && end == text.data() + text.size() ? gain : NAN;
}

/// One row more or number more than allowed is enough to see that there are too many.
Table table_of(std::istream& stream) {
  Table table;
  std::string line;
  while (table.size() <= kMostElevations && std::getline(stream, line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') {
      continue;
    }
    std::vector<double>& gains = table.emplace_back();
    std::size_t begin = 0;
    while (begin <= line.size() && gains.size() <= kMostAzimuths) {
      const std::size_t comma = std::min(line.find(',', begin), line.size());
      gains.push_back(gain_of(std::string_view{line}.substr(begin, comma - begin)));
      begin = comma + 1;
    }
  }
  return table;
}

/// The file is named beside the scenario and its text never shown: who runs this may be root.
std::optional<Table> table_of_file(const json& name, const std::string& path,
                                   const std::filesystem::path& folder, Problems& problems) {
  constexpr std::uintmax_t kMostBytes = 4'000'000;
  const std::string text = name.is_string() ? name.get<std::string>() : "";
  if (text.empty() || text.find('/') != std::string::npos) {
    problems.add(path, shown(name) + "; allowed: the name of a file beside the scenario");
    return std::nullopt;
  }
  std::error_code error;
  const std::filesystem::path file = folder / text;
  if (!std::filesystem::is_regular_file(file, error) ||
      std::filesystem::file_size(file, error) > kMostBytes) {
    problems.add(
        path,
        shown(name) + " cannot be read; allowed: a file of at most 4 MB beside the " + "scenario");
    return std::nullopt;
  }
  std::ifstream stream{file};
  return table_of(stream);
}

}  // namespace

Antenna read_antenna(const json* value, const std::string& path,
                     const std::filesystem::path& folder, Problems& problems) {
  if (value == nullptr || *value == "isotropic") {
    return IsotropicAntenna{};
  }
  if (*value == "dipole") {
    return DipoleAntenna{};
  }
  if (!value->is_object() || value->contains("gains") == value->contains("file")) {
    problems.add(path, shown(*value) + "; " + kAllowedAntennas);
    return IsotropicAntenna{};
  }
  ObjectReader reader{value, path, problems};
  std::optional<Table> table;
  std::string key = "gains";
  if (const json* gains = reader.child(key); gains != nullptr) {
    table = gains->is_array() ? table_of(*gains) : Table{};
  } else {
    key = "file";
    table = table_of_file(*reader.child(key), reader.path_of(key), folder, problems);
  }
  if (const auto fault = table ? fault_of(*table) : std::nullopt) {
    reader.problem(key, *fault);
  }
  reader.finish();
  return PatternAntenna{table.value_or(Table{{0.0}, {0.0}})};
}

}  // namespace cuscus::scenario
