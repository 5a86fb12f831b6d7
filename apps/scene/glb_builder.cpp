#include "apps/scene/glb_builder.h"

#include <array>
#include <bit>
#include <glm/common.hpp>
#include <limits>

#include "raster/base/check.h"

namespace limn::scene {
namespace {

void appendLittleEndian(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int k = 0; k < count; ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

template <class Vector>
std::span<const float> flat(std::span<const Vector> values) {
  static_assert(sizeof(Vector) % sizeof(float) == 0);
  constexpr std::size_t kComponents = sizeof(Vector) / sizeof(float);
  return {values.empty() ? nullptr : &values[0][0], kComponents * values.size()};
}

}  // namespace

int GlbBuilder::addView(std::span<const std::uint8_t> bytes, Target target) {
  while (binary_.size() % 4 != 0) binary_.push_back(0);
  nlohmann::ordered_json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != kNoTarget) view["target"] = static_cast<int>(target);
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  root["bufferViews"].push_back(std::move(view));
  return static_cast<int>(root["bufferViews"].size()) - 1;
}

int GlbBuilder::addAccessor(int view, ComponentType type, const std::string& shape, std::size_t count,
                            bool normalized) {
  nlohmann::ordered_json accessor = {
      {"bufferView", view}, {"componentType", static_cast<int>(type)}, {"count", count}, {"type", shape}};
  if (normalized) accessor["normalized"] = true;
  root["accessors"].push_back(std::move(accessor));
  return static_cast<int>(root["accessors"].size()) - 1;
}

int GlbBuilder::addFloats(std::span<const float> values, std::size_t components, Target target) {
  static constexpr std::array<const char*, 5> kShapes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) appendLittleEndian(bytes, std::bit_cast<std::uint32_t>(value), 4);
  return addAccessor(addView(bytes, target), kFloat, kShapes[components], values.size() / components);
}

int GlbBuilder::addVertices(std::span<const glm::vec2> values) {
  return addFloats(flat(values), 2, kVertices);
}
int GlbBuilder::addVertices(std::span<const glm::vec3> values) {
  return addFloats(flat(values), 3, kVertices);
}
int GlbBuilder::addVertices(std::span<const glm::vec4> values) {
  return addFloats(flat(values), 4, kVertices);
}
int GlbBuilder::addScalars(std::span<const float> values) {
  return addFloats(values, 1, kNoTarget);
}

int GlbBuilder::addPositions(std::span<const glm::vec3> values) {
  const int accessor = addVertices(values);
  glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
  for (const glm::vec3& value : values) {
    low = glm::min(low, value);
    high = glm::max(high, value);
  }
  nlohmann::ordered_json& json = root["accessors"].back();
  if (!values.empty()) {
    // Doubles of the floats: they print every digit, so that they read back as the same floats.
    json["min"] = std::array<double, 3>{low.x, low.y, low.z};
    json["max"] = std::array<double, 3>{high.x, high.y, high.z};
  }
  return accessor;
}

int GlbBuilder::addTriangles(std::span<const std::uint32_t> indices, std::size_t vertices) {
  const bool isShort = vertices <= 65535;  // 65535 itself restarts primitives
  std::vector<std::uint8_t> bytes;
  bytes.reserve((isShort ? 2 : 4) * indices.size());
  for (const std::uint32_t index : indices) appendLittleEndian(bytes, index, isShort ? 2 : 4);
  return addAccessor(addView(bytes, kIndices), isShort ? kUnsignedShort : kUnsignedInt, "SCALAR",
                     indices.size());
}

std::vector<std::uint8_t> GlbBuilder::finish() {
  while (binary_.size() % 4 != 0) binary_.push_back(0);
  for (const char* list : {"accessors", "bufferViews"})
    if (root.contains(list) && root[list].empty()) root.erase(list);  // glTF knows no empty lists
  if (!binary_.empty()) root["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string json = root.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  while (json.size() % 4 != 0) json += ' ';
  const std::size_t length = 20 + json.size() + (binary_.empty() ? 0 : 8 + binary_.size());
  require(length <= std::numeric_limits<std::uint32_t>::max(), "a GLB holds at most 4 GiB");

  std::vector<std::uint8_t> file;
  file.reserve(length);
  appendLittleEndian(file, 0x46546c67, 4);  // "glTF"
  appendLittleEndian(file, 2, 4);
  appendLittleEndian(file, static_cast<std::uint32_t>(length), 4);
  appendLittleEndian(file, static_cast<std::uint32_t>(json.size()), 4);
  appendLittleEndian(file, 0x4e4f534a, 4);  // "JSON"
  file.insert(file.end(), json.begin(), json.end());
  if (!binary_.empty()) {
    appendLittleEndian(file, static_cast<std::uint32_t>(binary_.size()), 4);
    appendLittleEndian(file, 0x004e4942, 4);  // "BIN"
    file.insert(file.end(), binary_.begin(), binary_.end());
  }
  return file;
}

}  // namespace limn::scene
