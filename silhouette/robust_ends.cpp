#include "silhouette/robust_ends.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "silhouette/edge_curves.h"
#include "silhouette/face_normal.h"

namespace limn::silhouette {
namespace {

using glm::cross;
using glm::dot;
using glm::vec3;

constexpr float kLimit = 1.25f;        // k
constexpr float kWitnessNone = -0.1f;  // shares of the bulge that the normals ask for
constexpr float kWitnessFull = 0.4f;
constexpr float kStencilError = 0.03f;      // τ, in edge lengths per radian
constexpr float kStencilErrorAngle = 0.6f;  // radians of dihedral angle that count
constexpr float kStencilShare = 0.35f;      // of what the stencil may be off for its shape
constexpr float kTiltOnset = 0.35f;
constexpr float kTiltWidth = 0.25f;
constexpr float kOnsetPerDeviation = 4.0f;
constexpr float kDeviationMost = 0.2f;
constexpr float kTurnFull = 1.0f / 3.0f;
constexpr float kOwnFull = 0.15f;  // ρ
constexpr float kOwnNone = 0.4f;
constexpr float kEvidenceNone = 0.6f;
constexpr float kEvidenceFull = 0.9f;
constexpr float kRegular = 0.15f;  // of the tilts
constexpr float kIrregular = 0.3f;
constexpr std::size_t kItemsPerBlock = 4096;

// The angle between two vectors within 7e-5 (Abramowitz & Stegun 4.4.45): a weight, not a measurement.
float angleBetween(const vec3& a, const vec3& b) {
  const float lengths = std::sqrt(dot(a, a) * dot(b, b));
  if (!(lengths > 0.0f)) return 0.0f;
  const float x = std::min(1.0f, std::fabs(dot(a, b)) / lengths);
  const float acute =
      std::sqrt(1.0f - x) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f - x * 0.0187293f)));
  return dot(a, b) < 0.0f ? 3.1415927f - acute : acute;
}

vec3 unit(const vec3& v) {
  const float length2 = dot(v, v);
  return length2 > 0.0f ? v / std::sqrt(length2) : vec3(0.0f);
}

std::uint32_t opposite(const Mesh& mesh, const Side& side) {
  return mesh.indices[3 * std::size_t{side.triangle} + (side.side + 2) % 3];
}

}  // namespace

// The six places around an edge that tell where its middle is.
struct RobustEnds::Stencil {
  Stencil(const vec3& p, const vec3& e) : start(p), edge(e), middle(p + 0.5f * e) {}

  void add(std::size_t k, float weight, const vec3& place) {
    offset += weight * (place - start);
    arms[k] = place - middle;
    weights[k] = weight;
  }
  float error(const vec3& up) const;

  vec3 start, edge, middle;
  vec3 offset{0.0f};  // of the butterfly's middle from the edge's
  std::array<vec3, 6> arms{};
  std::array<float, 6> weights{};
};

// How far the stencil is off on a quadric for its shape, about: half the curvature that heights over the edge show, times the
// weighted second moments of the places, ends included, along the edge and across.
float RobustEnds::Stencil::error(const vec3& up) const {
  const float edge2 = dot(edge, edge), offsetAlong = dot(offset, edge);
  float along = 0.25f * edge2 - offsetAlong * offsetAlong / edge2;
  float all = 0.25f * edge2 - dot(offset, offset), curvature = 0.0f;
  for (std::size_t k = 0; k < arms.size(); ++k) {
    const float x = dot(arms[k], edge), height = dot(arms[k], up), length2 = dot(arms[k], arms[k]);
    along += weights[k] * (x * x / edge2);
    all += weights[k] * length2;
    curvature += std::fabs(height) / std::max(length2 - height * height, 0.0625f * edge2);
  }
  return curvature / 6.0f * (std::fabs(along) + std::fabs(all - along));
}

void RobustEnds::prepare(const Mesh& mesh, const Topology& topology, const Crew& crew) {
  mesh_ = mesh;
  topology_ = &topology;
  computeFaceNormals(mesh, topology, crew, faceNormals_);
  ringNormals_.assign(topology.pointCount(), vec3(0.0f));
  for (std::size_t side = 0; side < mesh.indices.size(); ++side) {
    const std::size_t first = side - side % 3;
    const vec3& p = mesh.positions[mesh.indices[side]];
    const vec3 next = mesh.positions[mesh.indices[first + (side + 1) % 3]] - p;
    const vec3 before = mesh.positions[mesh.indices[first + (side + 2) % 3]] - p;
    ringNormals_[topology.points()[mesh.indices[side]]] +=
        angleBetween(next, before) * faceNormals_[side / 3];
  }
  deviations_.resize(mesh.normals.size());
  crew.forBlocks(deviations_.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const vec3 product = cross(mesh.normals[v], unit(ringNormals_[topology.points()[v]]));
      deviations_[v] = std::sqrt(dot(product, product));
    }
  });
  findTrust(crew);
  curvature_.prepare(mesh, topology, ringNormals_, isSmooth_, crew);
}

// Sums by blocks of edges, joined in order. A vertex counts once for each of its edges.
void RobustEnds::findTrust(const Crew& crew) {
  const std::vector<Edge>& edges = topology_->edges();
  isSmooth_.assign(topology_->pointCount(), 1);
  for (const Edge& edge : edges)
    if (edge.boundary || edge.isFeature()) isSmooth_[edge.point[0]] = isSmooth_[edge.point[1]] = 0;
  evidence_.assign((edges.size() + kItemsPerBlock - 1) / kItemsPerBlock, {});
  crew.forBlocks(edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    Evidence& sum = evidence_[begin / kItemsPerBlock];
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = edges[e];
      if (isSmooth_[edge.point[0]] == 0 || isSmooth_[edge.point[1]] == 0) continue;
      const std::array<std::uint32_t, 2> ends = edgeVertices(mesh_, edge)[0];
      const vec3 along = unit(mesh_.positions[ends[1]] - mesh_.positions[ends[0]]);
      const float hi = -dot(along, mesh_.normals[ends[0]]), hj = dot(along, mesh_.normals[ends[1]]);
      sum.differences += std::fabs(hi - hj);
      sum.tilts += std::fabs(hi + hj);
      sum.deviations += deviations_[ends[0]] + deviations_[ends[1]];
    }
  });
  Evidence all;
  for (const Evidence& sum : evidence_) {
    all.deviations += sum.deviations;
    all.differences += sum.differences;
    all.tilts += sum.tilts;
  }
  regularity_ = regularityOf(all.differences, all.tilts);
  trust_ = 1.0f;
  if (all.deviations < kEvidenceFull * all.differences)
    trust_ = trustOf(static_cast<float>(all.deviations / all.differences));
}

// 1 where tilts differ little in comparison with their means, 0 where they scatter.
float RobustEnds::regularityOf(double differences, double tilts) {
  if (!(differences < kIrregular * tilts)) return 0.0f;
  return 1.0f - smoothStep(kRegular, kIrregular, static_cast<float>(differences / tilts));
}

float RobustEnds::trustOf(float evidence) {
  return std::max(1.0f - smoothStep(kOwnFull, kOwnNone, evidence),
                  smoothStep(kEvidenceNone, kEvidenceFull, evidence));
}

// Where the butterfly scheme puts the edge's midpoint, less the midpoint. False where its stencil meets a
// boundary or a feature, beyond which positions tell nothing about this side.
bool RobustEnds::butterflyOffset(const Edge& edge, Stencil& stencil) const {
  std::size_t count = 0;
  for (const Side& face : edge.faces) {
    if (face.triangle == kNone) return false;
    stencil.add(count++, 0.125f, mesh_.positions[opposite(mesh_, face)]);
    for (std::uint32_t turn = 1; turn < 3; ++turn) {
      const std::uint32_t own = 3 * face.triangle + (face.side + turn) % 3;
      const Edge& wing = topology_->edges()[topology_->sideEdges()[own]];
      if (wing.boundary || wing.isFeature()) return false;
      const bool first = wing.faces[0].triangle == face.triangle && wing.faces[0].side == own % 3;
      stencil.add(count++, -0.0625f, mesh_.positions[opposite(mesh_, wing.faces[first ? 1 : 0])]);
    }
  }
  return true;
}

std::array<float, 2> RobustEnds::factors(const Edge& edge) const {
  const std::array<std::uint32_t, 2> ends = edgeVertices(mesh_, edge)[0];
  const vec3 &p = mesh_.positions[ends[0]], &ni = mesh_.normals[ends[0]], &nj = mesh_.normals[ends[1]];
  const vec3 e = mesh_.positions[ends[1]] - p;
  const float length = std::sqrt(dot(e, e));
  if (!(length > 0.0f)) return {0.0f, 0.0f};
  const float hi = -dot(e, ni) / length, hj = dot(e, nj) / length;
  const auto limited = [&](float own, float other) {
    return glm::mix(endLimit(kLimit, own, other), 1.0f, regularity_);
  };

  const float deviating = std::min(0.5f * (deviations_[ends[0]] + deviations_[ends[1]]), kDeviationMost);
  const float onset = kTiltOnset + kOnsetPerDeviation * deviating;
  float common = 1.0f - smoothStep(onset, onset + kTiltWidth, std::max(std::fabs(hi), std::fabs(hj)));

  common *= trust_;
  if (!(common > 0.0f)) return {0.0f, 0.0f};

  const auto turn = [&](std::size_t end) { return curvature_.turn(edge.point[end], e); };
  const float even = 0.5f * (turn(0) + turn(1));
  if (even > 0.0f) common *= smoothStep(0.0f, kTurnFull, std::fabs(hi + hj) / even);

  Stencil stencil(p, e);
  const float bulge = (hi + hj) / 8.0f;
  if (bulge != 0.0f && butterflyOffset(edge, stencil)) {
    const vec3 &ns = faceNormals_[edge.faces[0].triangle], &nt = faceNormals_[edge.faces[1].triangle];
    const vec3 sum = unit(ni + nj) + 0.5f * (ns + nt);
    const vec3 up = unit(sum - dot(sum, e) / (length * length) * e);
    const float seen = dot(stencil.offset, up) / length * (bulge > 0.0f ? 1.0f : -1.0f);
    const float granted = kStencilError * std::min(angleBetween(ns, nt), kStencilErrorAngle) +
                          regularity_ * kStencilShare * stencil.error(up) / length;
    common *= smoothStep(kWitnessNone, kWitnessFull, (seen + granted) / std::fabs(bulge));
  }
  return {common * limited(hi, hj), common * limited(hj, hi)};
}

}  // namespace limn::silhouette
