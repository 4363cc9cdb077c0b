#pragma once

#include <string>

#include "common/city/city.h"
#include "common/city/export/map_labels.h"

namespace cuscus::city {

/// The city as a binary glTF 2.0 model (Khronos, "glTF 2.0 Specification", 2021, section 4.4): one
/// mesh per wall material, one each for ground, trees and woods. glTF's axes: x east, y up, z
/// south. Each prism is a closed solid. No normals: viewers shade flat then, as the specification
/// demands.
[[nodiscard]] std::string glb_bytes(const City& city, const MapLabels& labels);

}  // namespace cuscus::city
