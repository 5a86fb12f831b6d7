// Writes small glTF files into memory, so that tests say in a few lines what a file holds.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene/gltf_load.h"
#include "apps/scene/load.h"

namespace limn::scene::test {

using nlohmann::json;

enum ComponentType {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

class GltfWriter {
 public:
  json root = {{"asset", {{"version", "2.0"}}}};

  /// Appends `values` to the binary chunk and returns the index of a new view of them.
  template <class T>
  int addView(const std::vector<T>& values, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    const std::size_t offset = binary.size(), bytes = values.size() * sizeof(T);
    binary.resize(offset + bytes);
    if (bytes > 0) std::memcpy(&binary[offset], values.data(), bytes);
    json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
    if (stride > 0) view["byteStride"] = stride;
    root["bufferViews"].push_back(view);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  int addAccessor(const json& accessor) {
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  /// A view and an accessor for all of it.
  template <class T>
  int addArray(const std::vector<T>& values, const char* type, bool normalized = false) {
    const std::size_t components = componentsOf(type);
    json accessor = {{"bufferView", addView(values)},
                     {"componentType", componentTypeOf(T{})},
                     {"count", values.size() / components},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return addAccessor(accessor);
  }

  /// A node with a mesh of one primitive; returns the primitive to be changed.
  json& addMesh(const json& attributes, int indices = -1, int mode = 4) {
    json primitive = {{"attributes", attributes}, {"mode", mode}};
    if (indices >= 0) primitive["indices"] = indices;
    root["meshes"].push_back({{"primitives", json::array({primitive})}});
    root["nodes"].push_back({{"mesh", root["meshes"].size() - 1}});
    return root["meshes"].back()["primitives"][0];
  }

  /// The right triangle (0,0,0), (1,0,0), (0,1,0).
  json& addTriangle() {
    return addMesh({{"POSITION", addArray<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}});
  }

  std::vector<std::uint8_t> glb() const {
    json document = root;
    if (!document.contains("buffers") && !binary.empty())
      document["buffers"] = json::array({{{"byteLength", binary.size()}}});
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> padded = binary;
    padded.resize((padded.size() + 3) / 4 * 4);
    std::vector<std::uint8_t> bytes;
    const auto append32 = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(value >> shift & 255U));
    };
    append32(0x46546C67);
    append32(2);
    append32(20 + text.size() + (padded.empty() ? 0 : 8 + padded.size()));
    append32(text.size());
    append32(0x4E4F534A);
    bytes.insert(bytes.end(), text.begin(), text.end());
    if (padded.empty()) return bytes;
    append32(padded.size());
    append32(0x004E4942);
    bytes.insert(bytes.end(), padded.begin(), padded.end());
    return bytes;
  }

  Scene load(const LoadOptions& options = {}) const {
    return loadGltf("test.glb", glb(), std::nullopt, options);
  }

  /// The message with which the file is refused, empty where it is not.
  std::string refusal() const {
    try {
      load();
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  std::vector<std::uint8_t> binary;

 private:
  static std::size_t componentsOf(const std::string& type) {
    if (type == "SCALAR") return 1;
    const std::size_t n = static_cast<std::size_t>(type.back() - '0');
    return type.starts_with("MAT") ? n * n : n;
  }
  static int componentTypeOf(float) { return kFloat; }
  static int componentTypeOf(std::int8_t) { return kByte; }
  static int componentTypeOf(std::uint8_t) { return kUnsignedByte; }
  static int componentTypeOf(std::int16_t) { return kShort; }
  static int componentTypeOf(std::uint16_t) { return kUnsignedShort; }
  static int componentTypeOf(std::uint32_t) { return kUnsignedInt; }
};

}  // namespace limn::scene::test
