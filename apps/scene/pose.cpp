#include "apps/scene/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "raster/base/check.h"

namespace limn::scene {
namespace {

/// Column-major translation · rotation · scale; the quaternion is taken as a unit one.
glm::dmat4 localMatrix(const Node& node) {
  if (node.matrix) return *node.matrix;
  const glm::dquat& q = node.rotation;
  const glm::dvec3 s = node.scale;
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {glm::dvec4(1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (xz - wy), 0) * s.x,
          glm::dvec4(2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (yz + wx), 0) * s.y,
          glm::dvec4(2 * (xz + wy), 2 * (yz - wx), 1 - 2 * (xx + yy), 0) * s.z,
          glm::dvec4(node.translation, 1)};
}

/// `matrix` · translation by the mesh's origin · its scale.
glm::dmat4 placeStored(const glm::dmat4& matrix, const Mesh& mesh) {
  return {matrix[0] * mesh.scale, matrix[1] * mesh.scale, matrix[2] * mesh.scale,
          matrix * glm::dvec4(mesh.origin, 1.0)};
}

/// Whether node `i` draws something: it is in the scene and its mesh has triangles.
bool isDrawn(const Scene& scene, std::size_t i) {
  const std::int32_t mesh = scene.nodes[i].mesh;
  return scene.inScene[i] && mesh >= 0 && !scene.meshes[static_cast<std::size_t>(mesh)].indices.empty();
}

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

/// Calls visit(world position) for every vertex that the pose draws.
template <class Visit>
void forEachPosition(const Scene& scene, const Pose& pose, const Visit& visit) {
  for (const Instance& instance : pose.instances) {
    const std::vector<glm::vec3>& positions =
        instance.deformed() ? instance.positions : scene.meshes[instance.mesh].positions;
    for (const glm::vec3& p : positions) visit(glm::dvec3(instance.toWorld * glm::dvec4(p, 1.0)));
  }
}

}  // namespace

glm::dquat unitQuaternion(const glm::dquat& q) {
  const double largest = std::max({std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  if (!(largest > 0.0)) return {1.0, 0.0, 0.0, 0.0};
  const glm::dquat s(q.w / largest, q.x / largest, q.y / largest, q.z / largest);  // squares cannot overflow
  const double length = std::sqrt(s.w * s.w + s.x * s.x + s.y * s.y + s.z * s.z);
  return {s.w / length, s.x / length, s.y / length, s.z / length};
}

void evaluatePose(const Scene& scene, int animation, double seconds, Pose& pose) {
  require(animation >= -1 && animation < static_cast<int>(scene.animations.size()), "no such animation");
  require(std::isfinite(seconds), "the time is not finite");
  pose.nodeToWorld.resize(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    const glm::dmat4 local = localMatrix(node);
    pose.nodeToWorld[i] =
        node.parent < 0 ? local : pose.nodeToWorld[static_cast<std::size_t>(node.parent)] * local;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (!isDrawn(scene, i)) continue;
    if (pose.instances.size() == count) pose.instances.emplace_back();
    Instance& instance = pose.instances[count++];
    instance.mesh = static_cast<std::uint32_t>(scene.nodes[i].mesh);
    instance.node = static_cast<std::uint32_t>(i);
    instance.toWorld = placeStored(pose.nodeToWorld[i], scene.meshes[instance.mesh]);
  }
  pose.instances.resize(count);
}

Sphere boundingSphere(const Scene& scene, const Pose& pose) {
  Bounds bounds;
  forEachPosition(scene, pose, [&](const glm::dvec3& p) {
    bounds.low = glm::min(bounds.low, p);
    bounds.high = glm::max(bounds.high, p);
  });
  if (!(bounds.low.x <= bounds.high.x)) return {};
  const glm::dvec3 center = 0.5 * bounds.low + 0.5 * bounds.high;
  double squared = 0.0;
  forEachPosition(scene, pose, [&](const glm::dvec3& p) {
    const glm::dvec3 d = p - center;
    squared = std::max(squared, glm::dot(d, d));
  });
  return {center, std::sqrt(squared)};
}

}  // namespace limn::scene
