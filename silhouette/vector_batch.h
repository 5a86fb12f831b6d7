// Many things at a time that a few vectors describe each, for the vector kernels.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

namespace limn::silhouette {

/// Up to 64 of them, of `kVectors` vectors each; structure of arrays.
template <std::size_t kVectors>
struct VectorBatch {
  static constexpr std::size_t kCapacity = 64;
  float coordinates[3 * kVectors][kCapacity];  ///< x, y and z of the first vector, of the second, …
  std::size_t count = 0;

  template <class... Vectors>
  void add(const Vectors&... vectors) {
    static_assert(sizeof...(Vectors) == kVectors);
    std::size_t k = 0;
    (put(k, vectors), ...);
    ++count;
  }
  glm::vec3 vector(std::size_t k, std::size_t i) const {
    return {coordinates[3 * k][i], coordinates[3 * k + 1][i], coordinates[3 * k + 2][i]};
  }

 private:
  void put(std::size_t& k, const glm::vec3& v) {
    coordinates[k++][count] = v.x;
    coordinates[k++][count] = v.y;
    coordinates[k++][count] = v.z;
  }
};

}  // namespace limn::silhouette
