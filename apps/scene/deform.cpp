// Based on: glTF 2.0 specification, sections 3.7.2.2 "Morph Targets" and 3.7.3 "Skins": linear blend skinning, the node's
// own transform is ignored.
// Differs in: normals go through the cofactors of the blended matrix, which are right for any scale; what is not finite
// becomes finite.
#include "apps/scene/deform.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "raster/base/workers.h"

namespace limn::scene {
namespace {

constexpr double kLargest = 1e15;

/// A float of at most 1e15 in magnitude.
float bounded(double x) {
  if (std::abs(x) <= kLargest) return static_cast<float>(x);
  return static_cast<float>(x > 0.0 ? kLargest : x < 0.0 ? -kLargest : 0.0);  // NaN: 0
}

glm::vec3 boundedVector(const glm::dvec3& v) {
  return {bounded(v.x), bounded(v.y), bounded(v.z)};
}

glm::vec3 unitOr(const glm::dvec3& v, const glm::vec3& otherwise) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0 && largest < 1e300)) return otherwise;
  const glm::dvec3 scaled = v / largest;
  return glm::vec3(scaled / std::sqrt(glm::dot(scaled, scaled)));
}

/// base + sum of weight · offset over the targets that have such offsets.
template <class Offsets>
glm::dvec3 morphed(const Mesh& mesh, const std::vector<float>& weights, const glm::dvec3& base,
                   std::size_t vertex, const Offsets& offsetsOf) {
  glm::dvec3 sum = base;
  for (std::size_t t = 0; t < weights.size(); ++t) {
    const std::vector<glm::vec3>& offsets = offsetsOf(mesh.targets[t]);
    if (weights[t] != 0.0f && !offsets.empty())
      sum += static_cast<double>(weights[t]) * glm::dvec3(offsets[vertex]);
  }
  return sum;
}

/// The place that posed positions of a skinned mesh are relative to: a translation, a scale by a power of two, and a
/// mirror where most joints mirror, so that triangles keep their winding.
struct Reference {
  glm::dvec3 center{0.0};
  double scale = 1.0;
  double mirror = 1.0;

  glm::dmat4 toWorld() const {
    glm::dmat4 matrix(scale);
    matrix[0][0] *= mirror;
    matrix[3] = glm::dvec4(center, 1.0);
    return matrix;
  }

  glm::dmat4 fromWorld(const glm::dmat4& matrix) const {
    glm::dmat4 result = matrix;
    result[3] -= glm::dvec4(center, 0.0);
    for (int c = 0; c < 4; ++c) {
      const double x = result[c].x * mirror;
      result[c] = glm::dvec4(glm::dvec3(x, result[c].y, result[c].z) / scale, result[c].w);
    }
    return result;
  }
};

Reference referenceOf(const std::vector<glm::dmat4>& joints) {
  Reference reference;
  glm::dvec3 sum(0.0);
  double largest = 0.0;
  int mirrored = 0;
  for (const glm::dmat4& joint : joints) {
    sum += glm::dvec3(joint[3]);
    for (int c = 0; c < 3; ++c) largest = std::max(largest, glm::length(glm::dvec3(joint[c])));
    const double volume = glm::determinant(glm::dmat3(joint));
    mirrored += volume < 0.0 ? 1 : volume > 0.0 ? -1 : 0;
  }
  const glm::dvec3 center = sum / static_cast<double>(joints.size());
  const bool isFinite = std::abs(center.x) + std::abs(center.y) + std::abs(center.z) < 1e30;
  if (isFinite) reference.center = center;
  if (largest > 1e-20 && largest < 1e20) {
    int exponent = 0;
    const double fraction = std::frexp(largest, &exponent);
    reference.scale = std::ldexp(1.0, fraction < 0.75 ? exponent - 1 : exponent);  // 1 stays 1
  }
  if (mirrored > 0) reference.mirror = -1.0;
  return reference;
}

/// The sum of weight · joint over all sets of a vertex.
glm::dmat4 blended(const Mesh& mesh, const std::vector<glm::dmat4>& joints, std::size_t vertex) {
  glm::dmat4 sum(0.0);
  for (const SkinBinding& set : mesh.skinning) {
    for (int k = 0; k < 4; ++k) {
      const double weight = set.weights[vertex][k];
      if (weight != 0.0) sum += weight * joints[set.joints[vertex][static_cast<std::size_t>(k)]];
    }
  }
  return sum;
}

void deformVertex(const Mesh& mesh, const std::vector<glm::dmat4>* joints, std::size_t v,
                  Instance& instance) {
  const auto& weights = instance.weights;
  glm::dvec3 position = morphed(
      mesh, weights, mesh.positions[v], v, [](const MorphTarget& t) -> auto& { return t.positions; });
  glm::dvec3 normal = morphed(
      mesh, weights, mesh.normals[v], v, [](const MorphTarget& t) -> auto& { return t.normals; });
  glm::dvec3 tangent(0.0);
  if (!mesh.tangents.empty()) {
    tangent = morphed(
        mesh, weights, glm::dvec3(mesh.tangents[v]), v,
        [](const MorphTarget& t) -> auto& { return t.tangents; });
  }
  if (joints != nullptr) {
    const glm::dmat4 matrix = blended(mesh, *joints, v);
    const glm::dmat3 linear(matrix);
    const double sign = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    position = glm::dvec3(matrix * glm::dvec4(position, 1.0));
    normal =
        sign * (normal.x * glm::cross(linear[1], linear[2]) + normal.y * glm::cross(linear[2], linear[0]) +
                normal.z * glm::cross(linear[0], linear[1]));
    tangent = linear * tangent;
  }
  instance.positions[v] = boundedVector(position);
  instance.normals[v] = unitOr(normal, mesh.normals[v]);
  if (!mesh.tangents.empty()) {
    instance.tangents[v] = glm::vec4(unitOr(tangent, glm::vec3(mesh.tangents[v])), mesh.tangents[v].w);
  }
}

}  // namespace

glm::dmat4 placeStored(const glm::dmat4& nodeToWorld, const Mesh& mesh) {
  return {nodeToWorld[0] * mesh.scale, nodeToWorld[1] * mesh.scale, nodeToWorld[2] * mesh.scale,
          nodeToWorld * glm::dvec4(mesh.origin, 1.0)};
}

void deform(const Mesh& mesh, const Skin* skin, const std::vector<glm::dmat4>& nodeToWorld,
            std::vector<glm::dmat4>& joints, Instance& instance, Workers* workers) {
  if (skin != nullptr) {
    joints.resize(skin->joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      joints[j] = placeStored(nodeToWorld[skin->joints[j]] * skin->inverseBind[j], mesh);
    }
    const Reference reference = referenceOf(joints);
    for (glm::dmat4& joint : joints) joint = reference.fromWorld(joint);
    instance.toWorld = reference.toWorld();
  }
  const std::size_t count = mesh.positions.size();
  instance.positions.resize(count);
  instance.normals.resize(count);
  instance.tangents.resize(mesh.tangents.size());
  const auto deformBlock = [&](std::size_t begin, std::size_t end, int /*slot*/) {
    for (std::size_t v = begin; v < end; ++v) deformVertex(mesh, skin ? &joints : nullptr, v, instance);
  };
  constexpr std::size_t kBlock = 1024;
  if (workers != nullptr)
    workers->forBlocks(count, kBlock, deformBlock);
  else
    deformBlock(0, count, 0);
}

}  // namespace limn::scene
