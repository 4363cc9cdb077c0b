// The city around the fleet.
#include <string>
#include <system_error>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

constexpr const char* kAllowedFile =
    "; allowed: a file's path, within the scenario's folder or absolute";

/// The absolute path of a file that exists; empty, with a problem, when there is none.
std::filesystem::path read_path(ObjectReader& reader, const std::string& key,
                                const std::filesystem::path& folder) {
  constexpr std::size_t kLongestPath_bytes = 4096;
  const std::string text = reader.text(key, {}, kLongestPath_bytes);
  const std::filesystem::path path{text};
  for (const auto& part : path) {
    if (path.is_relative() && part == "..") {
      reader.problem(key, shown(text) + " leaves the scenario's folder" + kAllowedFile);
      return {};
    }
  }
  std::filesystem::path file = (folder / path).lexically_normal();
  std::error_code error;
  if (text.empty() || !std::filesystem::is_regular_file(file, error)) {
    reader.problem(key, shown(text) + " is no file" + kAllowedFile);
    return {};
  }
  return file;
}

std::optional<std::array<double, 4>> read_bounds(const json* value, const std::string& path,
                                                 Problems& problems) {
  if (value == nullptr) {
    return std::nullopt;
  }
  ObjectReader reader{value, path, problems};
  std::array<double, 4> bounds_deg{};
  constexpr std::array<const char*, 4> kSides{"west", "south", "east", "north"};
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const double most_deg = side % 2 == 0 ? 180.0 : 90.0;
    if (!reader.has(kSides[side])) {
      reader.missing(kSides[side], "degrees of WGS-84");
    }
    bounds_deg[side] = reader.number(kSides[side], 0.0, {-most_deg, most_deg});
  }
  reader.finish();
  if (bounds_deg[0] >= bounds_deg[2] || bounds_deg[1] >= bounds_deg[3]) {
    problems.add(path, shown(*value) + "; allowed: west below east, south below north");
    return std::nullopt;
  }
  return bounds_deg;
}

GeneratedCity read_generated(ObjectReader& reader) {
  GeneratedCity city;
  city.style = reader.choice("generate", city.style, kCityStyleNames);
  if (reader.has("seed")) {
    city.seed = reader.integer<std::uint64_t>("seed", 1, {0, INT64_MAX});
  }
  city.size_m = reader.quantity("size", city.size_m, {kLength, "200 m", "2 km"});
  return city;
}

void read_heights(const json* value, const std::string& path, CitySection& city,
                  Problems& problems) {
  if (value == nullptr) {
    return;
  }
  const QuantityRange range{kLength, "2 m", "1000 m"};
  if (!value->is_array() || value->size() != 2) {
    problems.add(path,
                 shown(*value) + R"(; allowed: lowest and highest, such as ["10 m", "15 m"])");
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    city.heights_m[i] = read_quantity(value->at(i), path + '/' + std::to_string(i),
                                      city.heights_m[i], range, problems);
  }
  if (city.heights_m[0] > city.heights_m[1]) {
    problems.add(path, shown(*value) + "; allowed: the lowest first");
  }
}

}  // namespace

std::optional<CitySection> read_city(const json* value, const std::filesystem::path& folder,
                                     Problems& problems) {
  if (value == nullptr || (value->is_string() && *value == "none")) {
    return std::nullopt;
  }
  if (!value->is_object() || value->contains("file") == value->contains("generate")) {
    problems.add("/city",
                 (value->is_object() ? std::string{"has both or neither of file and generate"}
                                     : shown(*value)) +
                     R"(; allowed: "none", or an object with either "file" or "generate")");
    return std::nullopt;
  }
  CitySection city;
  ObjectReader reader{value, "/city", problems};
  if (reader.has("file")) {
    city.file = CityFile{
        .file = read_path(reader, "file", folder),
        .bounds_deg = read_bounds(reader.child("bounds"), reader.path_of("bounds"), problems)};
  } else {
    city.generated = read_generated(reader);
  }
  read_heights(reader.child("heights"), reader.path_of("heights"), city, problems);
  city.level_m = reader.quantity("level", city.level_m, {kLength, "2 m", "10 m"});
  city.walls = reader.choice("walls", city.walls, kMaterialNames);
  city.room_m = reader.quantity("room", city.room_m, {kLength, "0 m", "100 m"});
  if (city.room_m > 0.0 && city.room_m < 1.0) {
    reader.problem("room", "is between 0 m and 1 m; allowed: 0 m for none, or 1 m ... 100 m");
  }
  if (reader.has("terrain")) {
    city.terrain = read_path(reader, "terrain", folder);
  }
  reader.finish();
  return city;
}

}  // namespace cuscus::scenario
