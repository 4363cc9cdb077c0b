#include "common/city/export/glb.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/unit/common/city/export/sample_city.h"

namespace cuscus::city {
namespace {

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  REQUIRE(at + sizeof(value) <= bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

struct Parsed {
  nlohmann::json gltf;
  std::string binary;
};

/// Section 4.4 of the specification: a header of 12 bytes, then chunks of whole words.
Parsed parsed(const std::string& glb) {
  REQUIRE(glb.substr(0, 4) == "glTF");
  REQUIRE(word(glb, 4) == 2);
  REQUIRE(word(glb, 8) == glb.size());
  const std::uint32_t json_size = word(glb, 12);
  REQUIRE(json_size % 4 == 0);
  REQUIRE(glb.substr(16, 4) == "JSON");
  const std::size_t binary_at = 20 + json_size;
  REQUIRE(word(glb, binary_at) % 4 == 0);
  REQUIRE(glb.substr(binary_at + 4, 4) == std::string("BIN\0", 4));
  REQUIRE(binary_at + 8 + word(glb, binary_at) == glb.size());
  return {nlohmann::json::parse(glb.substr(20, json_size)), glb.substr(binary_at + 8)};
}

/// What an accessor holds, after its view and bounds have been checked against the buffer.
template <typename Value>
std::vector<Value> values_of(const Parsed& model, std::size_t number, std::size_t per_item) {
  const auto& accessor = model.gltf.at("accessors").at(number);
  const auto& view = model.gltf.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
  const auto from = view.at("byteOffset").get<std::size_t>();
  const auto size = view.at("byteLength").get<std::size_t>();
  const auto count = accessor.at("count").get<std::size_t>() * per_item;
  REQUIRE(from % sizeof(Value) == 0);
  REQUIRE(from + size <= model.binary.size());
  REQUIRE(count * sizeof(Value) == size);
  std::vector<Value> values(count);
  std::memcpy(values.data(), model.binary.data() + from, size);
  return values;
}

}  // namespace

TEST_CASE("A model's chunks, views, accessors and indices are within their bounds") {
  const Parsed model = parsed(glb_bytes(sample_city(), {.title = "t", .attribution = "a"}));

  REQUIRE(model.gltf.at("asset").at("version") == "2.0");
  REQUIRE(model.gltf.at("asset").at("copyright") == "a");
  REQUIRE(model.gltf.at("buffers").at(0).at("byteLength") == model.binary.size());
  std::set<std::string> names;
  for (const auto& mesh : model.gltf.at("meshes")) {
    names.insert(mesh.at("name"));
    const auto& primitive = mesh.at("primitives").at(0);
    REQUIRE(primitive.at("material") < model.gltf.at("materials").size());
    const auto number = primitive.at("attributes").at("POSITION").get<std::size_t>();
    const auto positions = values_of<float>(model, number, 3);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      REQUIRE(positions[i] >= model.gltf["accessors"][number]["min"][i % 3].get<float>());
      REQUIRE(positions[i] <= model.gltf["accessors"][number]["max"][i % 3].get<float>());
    }
    for (const std::uint32_t index :
         values_of<std::uint32_t>(model, primitive.at("indices").get<std::size_t>(), 1)) {
      REQUIRE(index < positions.size() / 3);
    }
  }
  REQUIRE(names == std::set<std::string>{"ground", "stone", "glass", "trees", "woods"});
  REQUIRE(model.gltf.at("scenes").at(0).at("nodes").size() == names.size());
}

TEST_CASE("A model has x east, y up and z south") {
  const Parsed model = parsed(glb_bytes(sample_city(), {}));

  for (const auto& mesh : model.gltf.at("meshes")) {
    if (mesh.at("name") == "glass") {
      const auto number = mesh["primitives"][0]["attributes"]["POSITION"].get<std::size_t>();
      const auto& accessor = model.gltf.at("accessors").at(number);
      // 0 to 30 m east and north, 0 to 90 m up.
      REQUIRE(accessor.at("min") == nlohmann::json::array({0.0, 0.0, -30.0}));
      REQUIRE(accessor.at("max") == nlohmann::json::array({30.0, 90.0, 0.0}));
    }
  }
  REQUIRE_FALSE(model.gltf.at("asset").contains("copyright"));
}

TEST_CASE("A city without anything is its ground") {
  City city;
  city.north_east_m = {10.0, 10.0};

  REQUIRE(parsed(glb_bytes(city, {})).gltf.at("meshes").size() == 1);
}

TEST_CASE("A city gives the same model each time") {
  REQUIRE(glb_bytes(sample_city(), {}) == glb_bytes(sample_city(), {}));
}

}  // namespace cuscus::city
