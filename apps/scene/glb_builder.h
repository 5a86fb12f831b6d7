// Writes GLB files: a JSON document and one buffer that grows with every array added.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace limn::scene {

class GlbBuilder {
 public:
  enum Target { kNoTarget = 0, kVertices = 34962, kIndices = 34963 };
  enum ComponentType {
    kByte = 5120,
    kUnsignedByte = 5121,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126
  };

  /// What the file says beside its buffers, views and accessors, to be filled by the caller.
  nlohmann::ordered_json root;

  /// Indices of what was added. Views start at multiples of four.
  int addView(std::span<const std::uint8_t> bytes, Target target);
  int addAccessor(int view, ComponentType type, const std::string& shape, std::size_t count,
                  bool normalized = false);

  int addVertices(std::span<const glm::vec2> values);
  int addVertices(std::span<const glm::vec3> values);
  int addVertices(std::span<const glm::vec4> values);
  /// With the bounds that glTF demands of positions.
  int addPositions(std::span<const glm::vec3> values);
  int addScalars(std::span<const float> values);
  /// Three per triangle; 16 bits where `vertices` allow it.
  int addTriangles(std::span<const std::uint32_t> indices, std::size_t vertices);

  /// The file. The builder is used up.
  std::vector<std::uint8_t> finish();

 private:
  int addFloats(std::span<const float> values, std::size_t components, Target target);

  std::vector<std::uint8_t> binary_;
};

}  // namespace limn::scene
