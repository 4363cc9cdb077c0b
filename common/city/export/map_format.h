#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/city/city.h"
#include "common/city/export/map_labels.h"

namespace cuscus::city {

enum class MapFormat : std::uint8_t { kJson, kSvg, kGlb };

/// By a file name's ending: .json, .svg or .glb.
[[nodiscard]] std::optional<MapFormat> map_format_of(std::string_view file_name);
inline constexpr const char* kMapFormats = "*.json, *.svg, *.glb";

/// The file's content.
[[nodiscard]] std::string map_bytes(const City& city, const MapLabels& labels, MapFormat format);

}  // namespace cuscus::city
