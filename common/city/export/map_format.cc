#include "common/city/export/map_format.h"

#include "common/city/export/glb.h"
#include "common/city/export/json.h"
#include "common/city/export/svg.h"

namespace cuscus::city {

std::optional<MapFormat> map_format_of(std::string_view file_name) {
  if (file_name.ends_with(".json")) {
    return MapFormat::kJson;
  }
  if (file_name.ends_with(".svg")) {
    return MapFormat::kSvg;
  }
  if (file_name.ends_with(".glb")) {
    return MapFormat::kGlb;
  }
  return std::nullopt;
}

std::string map_bytes(const City& city, const MapLabels& labels, MapFormat format) {
  switch (format) {
    case MapFormat::kJson:
      return json_text(city, labels);
    case MapFormat::kSvg:
      return svg_text(city, labels);
    case MapFormat::kGlb:
      return glb_bytes(city, labels);
  }
  return {};
}

}  // namespace cuscus::city
