// A scene at one moment: where every mesh, camera and light is.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "apps/scene/scene.h"

namespace limn {
class Workers;
}

namespace limn::scene {

/// One mesh placed in the world. Where the mesh deforms (skin or morph targets) the posed arrays are filled, one element
/// per vertex of the mesh, and toWorld places those; else they are empty, and toWorld places the mesh's own.
struct Instance {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;
  bool visible =
      true;  ///< false where a scale of 0 leaves nothing, or numbers overflow; toWorld is then of no use
  glm::dmat4 toWorld{1.0};  ///< affine; its determinant is negative where the instance is mirrored
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  std::vector<float> weights;  ///< of the mesh's morph targets
  bool deformed() const { return !positions.empty(); }
};

/// A node's own transform at the moment, where it has no matrix.
struct LocalTransform {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
};

/// Too large to multiply with coordinates and still be squared, or not finite.
bool isBeyondNumbers(const glm::dmat4& matrix);

struct Pose {
  std::vector<Instance> instances;      ///< in node order; the same ones at every moment
  std::vector<glm::dmat4> nodeToWorld;  ///< of every node
  std::vector<LocalTransform> local;    ///< of every node
  std::vector<glm::dmat4> joints;       ///< scratch: of one skin
  std::vector<double> values;           ///< scratch: of one animation channel
};

struct Sphere {
  glm::dvec3 center{0.0};
  double radius = 0.0;
};

/// Evaluates `animation` (-1: none, the rest pose) at `seconds`; before its first and after its last key the animation
/// stands still. Reuses the arrays of `pose`: nothing is allocated once they have their sizes. `workers` share the
/// vertices of deforming meshes; the result does not depend on them. Throws std::invalid_argument for an animation that is
/// not there or a time that is not finite.
void evaluatePose(const Scene& scene, int animation, double seconds, Pose& pose, Workers* workers = nullptr);

/// A sphere around everything that the pose draws, centred on its box; radius 0 for an empty one. Deterministic.
Sphere boundingSphere(const Scene& scene, const Pose& pose);

/// `q` scaled to length 1; the identity for a quaternion of length 0.
glm::dquat unitQuaternion(const glm::dquat& q);

}  // namespace limn::scene
