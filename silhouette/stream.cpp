#include <bit>
#include <cmath>

#include "silhouette/method.h"

namespace limn::silhouette {
namespace {

bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isOrigin(const Origin& origin, std::size_t triangles) {
  const float u = origin.weights.x, v = origin.weights.y;
  return origin.triangle < triangles && u >= 0.0f && v >= 0.0f && u + v <= 1.0f + 1e-6f;
}

}  // namespace

void RefinedStream::restart(std::size_t meshTriangles) {
  contour.clear();
  replaced.assign((meshTriangles + 63) / 64, 0);
}

// Arrays are not emptied before: only what they grow by is filled with zeros.
void RefinedStream::setCounts(std::size_t vertices, std::size_t triangles) {
  positions.resize(vertices);
  normals.resize(vertices);
  origins.resize(vertices);
  indices.resize(3 * triangles);
  sourceTriangles.resize(triangles);
}

void RefinedStream::clear(std::size_t meshTriangles) {
  restart(meshTriangles);
  setCounts(0, 0);
}

// The limits that Topology has for a mesh: a stream may become one.
void requireNumbered(std::size_t meshVertices, const StreamSize& size) {
  if (meshVertices + size.vertices >= kNone || 3 * size.triangles >= kNone)
    throw TooManyTriangles(TooManyTriangles::Limit::kIndices, size.triangles);
}

bool RefinedStream::isConsistent(const Mesh& mesh) const {
  const std::size_t triangles = mesh.triangleCount();
  if (normals.size() != positions.size() || origins.size() != positions.size()) return false;
  if (indices.size() != 3 * sourceTriangles.size() || replaced.size() != (triangles + 63) / 64) return false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const bool hasDirection = normals[i] != glm::vec3(0.0f);
    if (!isFinite(positions[i]) || !isFinite(normals[i]) || !hasDirection) return false;
    if (!isOrigin(origins[i], triangles)) return false;
  }
  for (const std::uint32_t index : indices)
    if (index >= mesh.positions.size() + positions.size()) return false;

  std::size_t sources = 0;
  for (std::size_t t = 0; t < sourceTriangles.size(); ++t) {
    const std::uint32_t source = sourceTriangles[t];
    if (source >= triangles || !isReplaced(source)) return false;
    if (t > 0 && source < sourceTriangles[t - 1]) return false;
    if (t == 0 || source != sourceTriangles[t - 1]) ++sources;
  }
  std::size_t bits = 0;
  for (const std::uint64_t word : replaced) bits += static_cast<std::size_t>(std::popcount(word));
  return bits == sources;
}

}  // namespace limn::silhouette
