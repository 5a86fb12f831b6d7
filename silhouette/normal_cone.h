// All directions in which a piece of a mesh faces, seen from somewhere.
//
// Based on: L. Shirman, S. Abi-Ezzi, "The cone of normals technique for fast processing of curved patches", 1993.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "silhouette/mesh.h"

namespace limn::silhouette {

/// Of unit facings ⟨n, v⟩.
struct FacingBound {
  float least = 0;   ///< all are at least so large and of one sign; 0: nothing is known
  float spread = 0;  ///< where least > 0: they differ by at most this
};

/// A sphere around points and a cone around unit normals.
struct NormalCone {
  glm::vec3 center{0.0f};
  float radius = 0;
  glm::vec3 axis{0.0f};
  float cosine = -1, sine = 0;  ///< of its half angle; cosine <= 0: no cone

  /// Around the points between two corners of a box, and around the direction of a sum of normals.
  void begin(const glm::vec3& low, const glm::vec3& high, const glm::vec3& sum);
  void include(const glm::vec3& normal) { cosine = std::min(cosine, glm::dot(axis, normal)); }
  /// After the last normal.
  void finish();

  /// Of all normals of the cone at all points of the sphere.
  FacingBound facings(const View& view) const;
};

}  // namespace limn::silhouette
