#include "apps/scene/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "apps/scene/animate.h"
#include "apps/scene/deform.h"
#include "raster/base/check.h"

namespace limn::scene {
namespace {

/// Column-major translation · rotation · scale; the quaternion is a unit one.
glm::dmat4 matrixOf(const LocalTransform& local) {
  const glm::dquat& q = local.rotation;
  const glm::dvec3 s = local.scale;
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {glm::dvec4(1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (xz - wy), 0) * s.x,
          glm::dvec4(2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (yz + wx), 0) * s.y,
          glm::dvec4(2 * (xz + wy), 2 * (yz - wx), 1 - 2 * (xx + yy), 0) * s.z,
          glm::dvec4(local.translation, 1)};
}

/// Whether node `i` draws something: it is in the scene and its mesh has triangles.
bool isDrawn(const Scene& scene, std::size_t i) {
  const std::int32_t mesh = scene.nodes[i].mesh;
  return scene.inScene[i] && mesh >= 0 && !scene.meshes[static_cast<std::size_t>(mesh)].indices.empty();
}

/// Neither nothing nor beyond numbers.
bool isVisible(const glm::dmat4& matrix) {
  constexpr double kSmallest = 1e-20;
  double scale = 0.0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) scale = std::max(scale, std::abs(matrix[c][r]));
  return scale > kSmallest && !isBeyondNumbers(matrix);
}

/// The instances and their rest weights; which ones there are depends on the scene alone.
void resetInstances(const Scene& scene, Pose& pose) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (!isDrawn(scene, i)) continue;
    if (pose.instances.size() == count) pose.instances.emplace_back();
    Instance& instance = pose.instances[count++];
    const Node& node = scene.nodes[i];
    instance.mesh = static_cast<std::uint32_t>(node.mesh);
    instance.node = static_cast<std::uint32_t>(i);
    const Mesh& mesh = scene.meshes[instance.mesh];
    instance.weights.assign(mesh.weights.begin(), mesh.weights.end());
    const std::size_t own = std::min(node.weights.size(), instance.weights.size());
    std::copy_n(node.weights.begin(), own, instance.weights.begin());
  }
  pose.instances.resize(count);
}

/// The instance of a node, or null where the node draws nothing.
Instance* instanceOf(Pose& pose, std::uint32_t node) {
  const auto found =
      std::lower_bound(pose.instances.begin(), pose.instances.end(), node,
                       [](const Instance& instance, std::uint32_t n) { return instance.node < n; });
  return found == pose.instances.end() || found->node != node ? nullptr : &*found;
}

void applyChannel(const AnimationChannel& channel, double seconds, Pose& pose) {
  std::vector<double>& value = pose.values;
  value.resize(channel.components);
  sampleChannel(channel, seconds, value);
  LocalTransform& local = pose.local[channel.node];
  switch (channel.path) {
    case ChannelPath::kTranslation:
      local.translation = {value[0], value[1], value[2]};
      break;
    case ChannelPath::kRotation:
      local.rotation = unitQuaternion({value[3], value[0], value[1], value[2]});
      break;
    case ChannelPath::kScale:
      local.scale = {value[0], value[1], value[2]};
      break;
    case ChannelPath::kWeights:
      if (Instance* instance = instanceOf(pose, channel.node)) {
        for (std::size_t t = 0; t < value.size(); ++t) instance->weights[t] = static_cast<float>(value[t]);
      }
      break;
  }
}

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

/// Calls visit(world position) for every vertex that the pose draws.
template <class Visit>
void forEachPosition(const Scene& scene, const Pose& pose, const Visit& visit) {
  for (const Instance& instance : pose.instances) {
    if (!instance.visible) continue;
    const std::vector<glm::vec3>& positions =
        instance.deformed() ? instance.positions : scene.meshes[instance.mesh].positions;
    for (const glm::vec3& p : positions) visit(glm::dvec3(instance.toWorld * glm::dvec4(p, 1.0)));
  }
}

}  // namespace

bool isBeyondNumbers(const glm::dmat4& matrix) {
  constexpr double kLargest = 1e30;  // two coordinates of 1e15 multiplied; their squares are doubles still
  double all = 0.0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) all += std::abs(matrix[c][r]);  // not finite if one of them is not
  return !(all < kLargest);
}

void evaluatePose(const Scene& scene, int animation, double seconds, Pose& pose, Workers* workers) {
  require(animation >= -1 && animation < static_cast<int>(scene.animations.size()), "no such animation");
  require(std::isfinite(seconds), "the time is not finite");
  resetInstances(scene, pose);
  pose.local.resize(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    pose.local[i] = {scene.nodes[i].translation, scene.nodes[i].rotation, scene.nodes[i].scale};
  }
  if (animation >= 0) {
    for (const AnimationChannel& channel : scene.animations[static_cast<std::size_t>(animation)].channels) {
      applyChannel(channel, seconds, pose);
    }
  }
  pose.nodeToWorld.resize(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    const glm::dmat4 local = node.matrix ? *node.matrix : matrixOf(pose.local[i]);
    pose.nodeToWorld[i] =
        node.parent < 0 ? local : pose.nodeToWorld[static_cast<std::size_t>(node.parent)] * local;
  }
  for (Instance& instance : pose.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const std::int32_t skin = scene.nodes[instance.node].skin;
    instance.toWorld = placeStored(pose.nodeToWorld[instance.node], mesh);
    if (skin >= 0 || !mesh.targets.empty()) {
      const Skin* bones = skin < 0 ? nullptr : &scene.skins[static_cast<std::size_t>(skin)];
      deform(mesh, bones, pose.nodeToWorld, pose.joints, instance, workers);
    }
    instance.visible = isVisible(instance.toWorld);
  }
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

glm::dquat unitQuaternion(const glm::dquat& q) {
  const double largest = std::max({std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  if (!(largest > 0.0)) return {1.0, 0.0, 0.0, 0.0};
  const glm::dquat s(q.w / largest, q.x / largest, q.y / largest, q.z / largest);  // squares cannot overflow
  const double length = std::sqrt(s.w * s.w + s.x * s.x + s.y * s.y + s.z * s.z);
  return {s.w / length, s.x / length, s.y / length, s.z / length};
}

}  // namespace limn::scene
