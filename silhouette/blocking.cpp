#include "silhouette/blocking.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "silhouette/edge_curves.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr float kFullConcavity =
    0.05f;  // sines of the chord's angles with the tangent planes: about 3 degrees
constexpr float kFullNearness = 0.25f;
constexpr float kFullAgreement = 0.2f;  // ⟨R̂, N_i⟩ below which a plane counts less

}  // namespace

float concavity(const vec3& chord, const vec3& n1, const vec3& n2) {
  const float length = glm::length(chord);
  const float least = std::min(dot(n1, chord), -dot(n2, chord));
  return least > 0.0f ? smoothStep(0.0f, kFullConcavity, least / length) : 0.0f;
}

float Blocking::nearnessWeight(float nearness) {
  return smoothStep(0.0f, kFullNearness, nearness);
}

void Blocking::prepare(const Mesh& mesh, const Topology& topology) {
  reach_.assign(topology.pointCount(), std::numeric_limits<float>::infinity());
  for (const Edge& edge : topology.edges()) {
    const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, edge)[0];
    const float length = glm::length(mesh.positions[ends[1]] - mesh.positions[ends[0]]);
    const bool stays = edge.boundary || edge.isFeature();
    for (const std::uint32_t point : edge.point)
      reach_[point] = stays ? 0.0f : std::min(reach_[point], kReach * length);
  }
  for (std::size_t side = 0; side < mesh.indices.size(); ++side)
    if (topology.isDegenerate(side / 3)) reach_[topology.points()[mesh.indices[side]]] = 0.0f;
  if (!sides_.empty()) return;

  firstSide_.assign(topology.pointCount() + 1, 0);
  for (const std::uint32_t vertex : mesh.indices) ++firstSide_[topology.points()[vertex] + 1];
  for (std::size_t p = 1; p < firstSide_.size(); ++p) firstSide_[p] += firstSide_[p - 1];
  std::vector<std::uint32_t> next(firstSide_.begin(), firstSide_.end() - 1);
  sides_.resize(mesh.indices.size());
  for (std::uint32_t side = 0; side < mesh.indices.size(); ++side)
    sides_[next[topology.points()[mesh.indices[side]]]++] = side;
}

// V' = V - max(δ, 0) R̂, δ = max_i w_i ⟨V - M_i, N_i⟩ / ⟨R̂, N_i⟩, R = Σ w_i N_i.
vec3 Blocking::displacement(const vec3& place, std::span<const BlockingPlane> planes) const {
  vec3 sum(0.0f);
  for (const BlockingPlane& plane : planes) sum += plane.weight * plane.normal;
  const float length = glm::length(sum);
  if (!(length > 0.0f)) return vec3(0.0f);
  const vec3 direction = sum / length;
  float deepest = 0.0f;
  for (const BlockingPlane& plane : planes) {
    const float agreement = dot(direction, plane.normal);
    if (agreement <= 0.0f) continue;
    const float height = dot(place - plane.middle, plane.normal);
    deepest =
        std::max(deepest, plane.weight * smoothStep(0.0f, kFullAgreement, agreement) * height / agreement);
  }
  return -std::min(deepest, reach_[planes[0].point]) * direction;
}

}  // namespace limn::silhouette
