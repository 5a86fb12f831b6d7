// Typed access to the arrays of a glTF file, every access checked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "apps/scene/gltf_document.h"

namespace limn::scene {

/// Checks every accessor of the file against its views and buffers: component types, strides, that all
/// elements lie in the view and the view in the buffer, the same for sparse ones. Reads no element. Throws
/// InputError with the place.
void checkAccessors(GltfDocument& document);

/// An accessor that passed checkAccessors, with its bytes at hand.
class AccessorReader {
 public:
  /// Throws InputError where the bytes are absent, or sparse indices do not ascend within the count.
  AccessorReader(GltfDocument& document, int accessor);

  std::size_t count() const { return count_; }
  std::size_t components() const { return components_; }
  int componentType() const { return componentType_; }
  bool normalized() const { return normalized_; }
  std::string place() const { return jsonPointer("accessors", index_); }

  /// Element `element`, its first `wanted` components, as numbers: normalized integers in [0, 1] or [-1, 1].
  /// Throws InputError for what is not finite or beyond 1e15 in magnitude.
  void read(std::size_t element, std::size_t wanted, float* out) const;
  /// The first `wanted` components of integers as they are.
  void readWhole(std::size_t element, std::size_t wanted, std::uint32_t* out) const;

 private:
  const std::uint8_t* find(std::size_t element) const;
  double component(const std::uint8_t* bytes) const;

  GltfDocument& document_;
  std::size_t index_ = 0, count_ = 0, components_ = 0, stride_ = 0;
  std::size_t componentBytes_ = 0;
  int componentType_ = 0;
  bool normalized_ = false;
  const std::uint8_t* bytes_ = nullptr;  ///< of element 0; null: all zeros
  std::vector<std::uint32_t> sparseElements_;
  const std::uint8_t* sparseBytes_ = nullptr;
};

/// The elements that `elements` lists (all of them in order where it is null) as glm vectors or floats.
template <class Vector>
std::vector<Vector> gather(GltfDocument& document, const AccessorReader& reader,
                           const std::vector<std::uint32_t>* elements) {
  constexpr std::size_t kComponents = sizeof(Vector) / sizeof(float);  // NOLINT(bugprone-sizeof-expression)
  const std::size_t count = elements ? elements->size() : reader.count();
  document.charge(count * sizeof(Vector), reader.place());
  std::vector<Vector> result(count);
  std::array<float, kComponents> values{};
  for (std::size_t i = 0; i < count; ++i) {
    reader.read(elements ? (*elements)[i] : i, kComponents, values.data());
    std::memcpy(&result[i], values.data(), sizeof values);
  }
  return result;
}

}  // namespace limn::scene
