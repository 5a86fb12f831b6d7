// The unit normals of triangles.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "silhouette/method.h"

namespace limn::silhouette {

/// Zero for triangles without area. In double precision: the corners of a needle differ in their last digits
/// only.
inline glm::vec3 faceNormal(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const glm::dvec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double length = glm::length(normal);
  return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f);
}

/// Those of all triangles; zero for degenerate ones.
inline void computeFaceNormals(const Mesh& mesh, const Topology& topology, const Crew& crew,
                               std::vector<glm::vec3>& normals) {
  normals.resize(mesh.triangleCount());
  crew.forBlocks(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      normals[t] = topology.isDegenerate(t) ? glm::vec3(0.0f) : faceNormal(mesh, t);
  });
}

}  // namespace limn::silhouette
