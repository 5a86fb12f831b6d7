// A scene at one moment: where every mesh, camera and light is.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/scene/scene.h"

namespace limn::scene {

/// One mesh placed in the world. Where the mesh deforms (skin or morph targets) the posed arrays are filled:
/// positions relative to `meshOrigin`, and toWorld places those.
struct Instance {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;
  glm::dmat4 toWorld{1.0};  ///< from the mesh's re-based coordinates (positions as stored) to the world
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  bool deformed() const { return !positions.empty(); }
};

struct Pose {
  std::vector<Instance> instances;      ///< in node order
  std::vector<glm::dmat4> nodeToWorld;  ///< of every node
};

struct Sphere {
  glm::dvec3 center{0.0};
  double radius = 0.0;
};

/// `q` scaled to length 1; the identity for a quaternion of length 0.
glm::dquat unitQuaternion(const glm::dquat& q);

/// Evaluates `animation` (-1: none, the rest pose) at `seconds`. Reuses the arrays of `pose`.
void evaluatePose(const Scene& scene, int animation, double seconds, Pose& pose);

/// A sphere around everything that the pose draws; radius 0 for an empty one. Deterministic.
Sphere boundingSphere(const Scene& scene, const Pose& pose);

}  // namespace limn::scene
