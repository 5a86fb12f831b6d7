// Writes vertices into a stream, each with its shading normal and origin.
//
// Based on: A. Vlachos, J. Peters, C. Boyd, J. Mitchell, "Curved PN triangles", 2001, for the quadratic
// normals. Differs in: the middle coefficients blend with those of linear normals by the α of their sides, so
// that the shading is continuous with flat neighbours and with the flat triangle itself.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "silhouette/face_normal.h"
#include "silhouette/refine.h"

namespace limn::silhouette {

/// The weights of corners 1 and 2 at t along a side.
inline glm::vec2 sideWeights(std::uint32_t side, float t) {
  if (side == 0) return {t, 0.0f};
  if (side == 1) return {1.0f - t, t};
  return {0.0f, 1.0f - t};
}

class StreamWriter {
 public:
  StreamWriter(const Mesh& mesh, ShadingNormals shading, RefinedStream& stream)
      : mesh_(mesh), quadratic_(shading == ShadingNormals::kQuadratic), stream_(stream) {}

  /// Vertex `at` of the stream; `alphas` are those of the origin's sides, looked at for quadratic normals
  /// only.
  void vertex(std::uint32_t at, const glm::vec3& position, const Origin& origin,
              const std::array<float, 3>& alphas) {
    stream_.positions[at] = position;
    stream_.normals[at] = normal(origin, alphas);
    stream_.origins[at] = origin;
  }

  /// Triangle `at` of the stream.
  void triangle(std::uint32_t at, std::uint32_t source, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::uint32_t* index = &stream_.indices[3 * std::size_t{at}];
    index[0] = a;
    index[1] = b;
    index[2] = c;
    stream_.sourceTriangles[at] = source;
  }

 private:
  // Where the corners' normals cancel, the face's; for a triangle that has none either, any.
  glm::vec3 normal(const Origin& origin, const std::array<float, 3>& alphas) const {
    const std::uint32_t* corner = &mesh_.indices[3 * std::size_t{origin.triangle}];
    const std::array<glm::vec3, 3> n = {mesh_.normals[corner[0]], mesh_.normals[corner[1]],
                                        mesh_.normals[corner[2]]};
    const float v = origin.weights.x, w = origin.weights.y, u = 1.0f - v - w;
    const glm::vec3 sum =
        quadratic_ ? u * u * n[0] + v * v * n[1] + w * w * n[2] + u * v * middle(corner, 0, alphas) +
                         v * w * middle(corner, 1, alphas) + w * u * middle(corner, 2, alphas)
                   : u * n[0] + v * n[1] + w * n[2];
    if (glm::dot(sum, sum) > 1e-12f) return sum;
    const glm::vec3 face = faceNormal(mesh_, origin.triangle);
    return face != glm::vec3(0.0f) ? face : glm::vec3(0.0f, 0.0f, 1.0f);
  }

  // n110 of the paper: the ends' mean normal mirrored in the plane that halves the side.
  glm::vec3 middle(const std::uint32_t* corner, std::size_t side, const std::array<float, 3>& alphas) const {
    const std::uint32_t from = corner[side], to = corner[side == 2 ? 0 : side + 1];
    const glm::vec3 sum = mesh_.normals[from] + mesh_.normals[to],
                    e = mesh_.positions[to] - mesh_.positions[from];
    const float length2 = glm::dot(e, e);
    if (!(length2 > 0.0f)) return sum;
    const glm::vec3 mirrored = sum - (2.0f * glm::dot(e, sum) / length2) * e;
    const float size2 = glm::dot(mirrored, mirrored);
    if (!(size2 > 1e-12f)) return sum;
    return (1.0f - alphas[side]) * sum + (alphas[side] / std::sqrt(size2)) * mirrored;
  }

  const Mesh& mesh_;
  bool quadratic_;
  RefinedStream& stream_;
};

/// Sets the bit of a triangle. Blocks may share a word, unless they are `alone`: one after the other.
inline void markTriangle(std::vector<std::uint64_t>& bits, std::uint32_t triangle, bool alone) {
  const std::uint64_t bit = std::uint64_t{1} << (triangle % 64);
  if (alone)
    bits[triangle / 64] |= bit;
  else
    std::atomic_ref<std::uint64_t>(bits[triangle / 64]).fetch_or(bit, std::memory_order_relaxed);
}

}  // namespace limn::silhouette
