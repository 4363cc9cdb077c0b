#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "common/city/city.h"

namespace cuscus::scenario {

/// Cities that cuscus can make by itself.
enum class CityStyle { kOldTown, kGrid };

struct CityFile {
  std::filesystem::path file;  ///< Absolute.
  /// Degrees of WGS-84: west, south, east, north. Nothing: all of the file.
  std::optional<std::array<double, 4>> bounds_deg;
};

struct GeneratedCity {
  CityStyle style{CityStyle::kOldTown};
  std::optional<std::uint64_t> seed;  ///< Nothing: the scenario's.
  double size_m{600.0};               ///< Side of the square.
};

/// What stands around the fleet, and what its map does not say.
struct CitySection {
  std::optional<CityFile> file;  ///< This or the next.
  std::optional<GeneratedCity> generated;
  std::array<double, 2> heights_m{10.0, 15.0};  ///< Of buildings without height: from, to.
  double level_m{3.0};
  city::Material walls{city::Material::kConcrete};
  double room_m{0.0};             ///< 0: no inner walls.
  std::filesystem::path terrain;  ///< Empty: the ground is flat.
};

}  // namespace cuscus::scenario
