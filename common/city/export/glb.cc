#include "common/city/export/glb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/city/export/solids.h"
#include "common/city/names.h"

namespace cuscus::city {
namespace {

using Json = nlohmann::ordered_json;

// Values of the specification: sections 4.4.1, 4.4.3.1, 3.6.2.2 and 5.11.5.
constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::uint32_t kFloat = 5126;
constexpr std::uint32_t kUnsignedInt = 5125;
constexpr std::uint32_t kArrayBuffer = 34962;
constexpr std::uint32_t kElementArrayBuffer = 34963;

static_assert(std::endian::native == std::endian::little, "glTF is little endian");

struct Look {
  std::array<double, 3> colour;  ///< Linear red, green and blue, as glTF has them.
  double metallic{0.0};
  double roughness{0.9};
};

Look look_of(Material material) {
  switch (material) {
    case Material::kStone:
      return {.colour = {0.50, 0.42, 0.30}};
    case Material::kConcrete:
      return {.colour = {0.45, 0.45, 0.45}};
    case Material::kBrick:
      return {.colour = {0.36, 0.12, 0.07}};
    case Material::kGlass:
      return {.colour = {0.18, 0.32, 0.42}, .metallic = 0.4, .roughness = 0.2};
    case Material::kMetal:
      return {.colour = {0.40, 0.41, 0.43}, .metallic = 1.0, .roughness = 0.4};
    case Material::kWood:
      return {.colour = {0.30, 0.18, 0.08}};
  }
  return {.colour = {0.5, 0.5, 0.5}};
}

template <typename Value>
void append(const Value& value, std::string& bytes) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

// NOLINTNEXTLINE(bugprone-exception-escape): of its implicit moves, which throw nothing
class Model {
 public:
  void add(const std::string& name, const SolidMesh& mesh, const Look& look) {
    if (mesh.triangles.empty()) {
      return;
    }
    const std::size_t positions = add_positions(mesh);
    const std::size_t indices = add_indices(mesh);
    gltf_["materials"].push_back(
        {{"name", name},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {look.colour[0], look.colour[1], look.colour[2], 1.0}},
           {"metallicFactor", look.metallic},
           {"roughnessFactor", look.roughness}}}});
    const std::size_t number = gltf_["meshes"].size();
    gltf_["meshes"].push_back(
        {{"name", name},
         {"primitives", Json::array({{{"attributes", {{"POSITION", positions}}},
                                      {"indices", indices},
                                      {"material", number}}})}});
    gltf_["nodes"].push_back({{"name", name}, {"mesh", number}});
    gltf_["scenes"][0]["nodes"].push_back(number);
  }

  std::string bytes(const City& city, const MapLabels& labels) {
    gltf_["asset"] = {{"version", "2.0"}, {"generator", "cuscus"}};
    if (!labels.attribution.empty()) {
      gltf_["asset"]["copyright"] = labels.attribution;
    }
    gltf_["asset"]["extras"] = {{"title", labels.title},
                                {"latitude_deg", city.origin.latitude_deg},
                                {"longitude_deg", city.origin.longitude_deg},
                                {"height_m", city.origin.height_m}};
    gltf_["scene"] = 0;
    gltf_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    std::string json = gltf_.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.append((4 - json.size() % 4) % 4, ' ');
    std::string out;
    append(kMagic, out);
    append(kVersion, out);
    constexpr std::size_t kHeaders = 12 + 8 + 8;
    append(static_cast<std::uint32_t>(kHeaders + json.size() + binary_.size()), out);
    append(static_cast<std::uint32_t>(json.size()), out);
    append(kJsonChunk, out);
    out += json;
    append(static_cast<std::uint32_t>(binary_.size()), out);
    append(kBinaryChunk, out);
    return out + binary_;
  }

 private:
  std::size_t add_view(std::size_t from, std::uint32_t target) {
    gltf_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", from},
                                    {"byteLength", binary_.size() - from},
                                    {"target", target}});
    return gltf_["bufferViews"].size() - 1;
  }

  std::size_t add_positions(const SolidMesh& mesh) {
    const std::size_t from = binary_.size();
    std::array<float, 3> least;
    std::array<float, 3> most;
    least.fill(std::numeric_limits<float>::max());
    most.fill(std::numeric_limits<float>::lowest());
    for (const Eigen::Vector3d& p : mesh.corners) {
      // East, up, south.
      const std::array<float, 3> corner{static_cast<float>(p.x()), static_cast<float>(p.z()),
                                        static_cast<float>(-p.y())};
      for (std::size_t i = 0; i < corner.size(); ++i) {
        least[i] = std::min(least[i], corner[i]);
        most[i] = std::max(most[i], corner[i]);
        append(corner[i], binary_);
      }
    }
    const std::size_t view = add_view(from, kArrayBuffer);
    gltf_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", kFloat},
                                  {"count", mesh.corners.size()},
                                  {"type", "VEC3"},
                                  {"min", least},
                                  {"max", most}});
    return gltf_["accessors"].size() - 1;
  }

  std::size_t add_indices(const SolidMesh& mesh) {
    const std::size_t from = binary_.size();
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        append(corner, binary_);
      }
    }
    const std::size_t view = add_view(from, kElementArrayBuffer);
    gltf_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", kUnsignedInt},
                                  {"count", mesh.triangles.size() * 3},
                                  {"type", "SCALAR"}});
    return gltf_["accessors"].size() - 1;
  }

  Json gltf_;
  std::string binary_;
};

}  // namespace

std::string glb_bytes(const City& city, const MapLabels& labels) {
  Model model;
  SolidMesh ground;
  ground.add_ground(city);
  model.add("ground", ground, {.colour = {0.55, 0.55, 0.50}});
  std::array<SolidMesh, kMaterials> walls;
  for (const Building& building : city.buildings) {
    for (const Prism& prism : building.prisms) {
      walls[static_cast<std::size_t>(building.outer_walls)].add_prism(prism.footprint,
                                                                      prism.bottom_m, prism.top_m);
    }
  }
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto material = static_cast<Material>(i);
    model.add(std::string{name_of(material)}, walls[i], look_of(material));
  }
  SolidMesh trees;
  for (const Tree& tree : city.trees) {
    trees.add_tree(tree);
  }
  model.add("trees", trees, {.colour = {0.06, 0.20, 0.05}});
  SolidMesh woods;
  for (const Wood& wood : city.woods) {
    woods.add_prism(wood.footprint, wood.bottom_m, wood.top_m);
  }
  model.add("woods", woods, {.colour = {0.05, 0.16, 0.05}});
  return model.bytes(city, labels);
}

}  // namespace cuscus::city
