#include "common/scenario/scenario.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <type_traits>
#include <utility>

#include "common/scenario/json_document.h"
#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

bool is_run_name(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  const auto is_letter_or_digit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  if (name.empty() || name.size() > kLongest || !is_letter_or_digit(name.front())) {
    return false;
  }
  for (const char c : name) {
    if (!is_letter_or_digit(c) && c != '-' && c != '_' && c != '.') {
      return false;
    }
  }
  return true;
}

ClockSource read_clock(ObjectReader& reader) {
  const json* value = reader.child("clock");
  if (value != nullptr && *value == "virtual") {
    reader.problem("clock", "\"virtual\" is not built yet; allowed: real");
    return ClockSource::kReal;
  }
  return reader.choice("clock", ClockSource::kReal, kClockNames);
}

Scenario read_document(const json& document, const std::filesystem::path& folder,
                       Problems& problems) {
  Scenario scenario;
  scenario.folder = folder;
  ObjectReader reader{&document, "", problems};
  static_cast<void>(reader.text("$schema", {}, 4096));  // for editors
  if (reader.has("name")) {
    scenario.name = reader.text("name", "unnamed", 256);
    if (!is_run_name(scenario.name)) {
      reader.problem("name", shown(scenario.name) +
                                 " cannot name a run directory; allowed: 1 ... 64 letters, digits, "
                                 "'-', '_' and '.', a letter or digit first");
    }
  } else {
    static_cast<void>(reader.child("name"));
    reader.missing("name", "letters, digits, '-', '_' and '.'; it names the run directory");
  }
  scenario.description = reader.text("description", {}, 10'000);
  scenario.seed = reader.integer<std::uint64_t>("seed", scenario.seed, {0, INT64_MAX});
  scenario.duration = reader.duration("duration", scenario.duration, "1 s", "24 h");
  scenario.clock = read_clock(reader);
  scenario.realtime = reader.boolean("realtime", scenario.realtime);
  scenario.on_late = reader.choice("on_late", scenario.on_late, kOnLateNames);
  scenario.city = read_city(reader.child("city"), folder, problems);
  scenario.radio = read_radio(reader.child("radio"), folder, problems);
  scenario.network = read_network(reader.child("network"), problems);
  scenario.world = read_world(reader.child("world"), problems);
  scenario.fleet = read_fleet(reader.child("fleet"), folder, problems);
  scenario.ground_station = read_ground_station(reader.child("ground_station"), problems);
  scenario.record = read_record(reader.child("record"), problems);
  reader.finish();
  return scenario;
}

std::string read_file(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& message) {
    throw ScenarioError{{{file.string(), "", message}}};
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    fail("does not exist");
  }
  if (!std::filesystem::is_regular_file(status)) {
    fail("is not a file");
  }
  const auto bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > kMaxDocumentBytes) {
    fail("is " + std::to_string(bytes) + " B long; allowed: up to " +
         std::to_string(kMaxDocumentBytes) + " B");
  }
  std::ifstream stream{file, std::ios::binary};
  std::string text{std::istreambuf_iterator<char>{stream}, {}};
  if (!stream) {
    fail("cannot be read");
  }
  return text;
}

}  // namespace

std::uint32_t Scenario::uav_count() const {
  std::uint32_t count = 0;
  for (const Group& group : fleet) {
    count += group.count;
  }
  return count;
}

std::uint32_t Scenario::node_count() const {
  return uav_count() + (ground_station.enabled ? 1 : 0);
}

Scenario parse_scenario(std::string_view text, const std::string& source,
                        const std::filesystem::path& folder, std::span<const Override> overrides) {
  json document = parse_document(text, source);
  std::vector<std::pair<std::string, std::string>> overridden;
  for (const Override& override : overrides) {
    overridden.emplace_back(apply_override(override, document), override.option);
  }
  Problems problems{source, std::move(overridden)};
  Scenario scenario = read_document(document, folder, problems);
  problems.throw_if_any();
  check_against_schema(document, problems);
  check_whole(scenario, problems);
  problems.throw_if_any();
  return scenario;
}

Scenario load_scenario(const std::filesystem::path& file, std::span<const Override> overrides) {
  const std::string text = read_file(file);
  return parse_scenario(text, file.string(), std::filesystem::absolute(file).parent_path(),
                        overrides);
}

std::string uav_name(const Group& group, std::uint32_t member) {
  return group.name + std::to_string(member);
}

namespace {

std::vector<Position_m> positions(const CircleLayout& circle, std::uint32_t count) {
  std::vector<Position_m> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / count;
    result.push_back({circle.centre_m[0] + circle.radius_m * std::cos(angle_rad),
                      circle.centre_m[1] + circle.radius_m * std::sin(angle_rad),
                      circle.centre_m[2]});
  }
  return result;
}

std::vector<Position_m> positions(const GridLayout& grid, std::uint32_t count) {
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const std::uint32_t rows = (count + columns - 1) / columns;
  std::vector<Position_m> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double column = i % columns - (columns - 1) / 2.0;
    const std::uint32_t row_index = i / columns;
    const double row = row_index - (rows - 1) / 2.0;
    result.push_back({grid.centre_m[0] + grid.spacing_m * column,
                      grid.centre_m[1] + grid.spacing_m * row, grid.centre_m[2]});
  }
  return result;
}

std::vector<Position_m> positions(const LineLayout& line, std::uint32_t count) {
  std::vector<Position_m> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double along_m = line.spacing_m * (i - (count - 1) / 2.0);
    result.push_back({line.centre_m[0] + along_m * std::cos(line.direction_rad),
                      line.centre_m[1] + along_m * std::sin(line.direction_rad), line.centre_m[2]});
  }
  return result;
}

std::vector<Position_m> positions(const ListLayout& list, std::uint32_t /*count*/) {
  return list.positions_m;
}

}  // namespace

std::vector<Position_m> start_positions(const Group& group) {
  return std::visit([&group](const auto& layout) { return positions(layout, group.count); },
                    group.start.layout);
}

}  // namespace cuscus::scenario
