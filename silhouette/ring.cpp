#include "silhouette/ring.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "silhouette/contour.h"
#include "silhouette/silhouetteness.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr float kBeta = 0.02f;   // of (2): narrow, what matters is the outline
constexpr float kFacing = 0.2f;  // sine of the angle from the contour at which a
                                 // corner's cover is over
// Edge lengths by which the edge must pass what covers it to count, and to count wholly. Its curve begins late,
// as every convex smooth shape has such edges; its chord, which would hide a concave segment, early.
constexpr float kCurveBehind = 0.01f, kCurveOut = 0.06f;
constexpr float kChordBehind = -0.02f, kChordOut = 0.01f;

}  // namespace

float RingTest::largestProduct() const {
  float distance = 1.0f;
  if (view.projection.perspective) distance = glm::length(view.eye - curves.middle) + curves.radius;
  return 1.01f * kBeta * distance * distance;  // roundings are far below a hundredth of β
}

// How near a corner is to the contour: 1 there, 0 from kFacing on.
float RingTest::coverOf(std::uint32_t corner) const {
  const vec3 v = towardsEye(view, mesh.positions[corner]);
  const float length2 = dot(v, v), height = heights[corner];
  if (!(height * height < kFacing * kFacing * length2)) return 0.0f;
  return 1.0f - smoothStep(0.0f, kFacing, std::abs(height) / std::sqrt(length2));
}

// How far the middle of the edge, curved or straight, is outside the tangent plane at a place on the contour: 0
// … 1.
float RingTest::standsOut(std::uint32_t e, const vec3& place, const vec3& normal) const {
  const float size2 = dot(normal, normal);
  if (!(size2 > 0.0f)) return 1.0f;
  const std::array<std::uint32_t, 2>& ends = curves.vertices[e][0];
  const vec3 &p = mesh.positions[ends[0]], &q = mesh.positions[ends[1]];
  const float scale = 1.0f / (std::sqrt(size2) * glm::length(q - p));
  const float chord = dot(0.5f * (p + q) - place, normal) * scale;
  const float curve = chord + dot(curveOffset(curves.curves[e], 0.5f), normal) * scale;
  return std::max(smoothStep(kChordBehind, kChordOut, chord), smoothStep(kCurveBehind, kCurveOut, curve));
}

// How much of the edge the viewer sees beside the contour in a triangle at the edge: the segment there, and the
// corners near the contour, which are all that is left of a segment that has shrunk into one.
float RingTest::exposed(std::uint32_t e, const Side& face) const {
  const std::uint32_t first = 3 * face.triangle;
  vec3 middle(0.0f), normal(0.0f);
  float least = 1.0f;
  int ends = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = mesh.indices[first + k];
    const float covered = coverOf(corner);
    if (covered > 0.0f)
      least = std::min(least,
                       1.0f - covered * (1.0f - standsOut(e, mesh.positions[corner], mesh.normals[corner])));

    const std::uint32_t other = topology.sideEdges()[first + k];
    const Edge& edge = topology.edges()[other];
    const std::size_t own = edge.faces[0].triangle == face.triangle && edge.faces[0].side == k ? 0 : 1;
    const std::array<std::uint32_t, 2>& v = curves.vertices[other][own];
    if (visible[v[0]] == visible[v[1]] || edge.nonManifold) continue;
    const vec3 &p = mesh.positions[v[0]], &q = mesh.positions[v[1]];
    const float t = crossings[other][own];
    middle += 0.5f * curvePoint(p, q, curves.curves[other], t);
    normal += (1.0f - t) * mesh.normals[v[0]] + t * mesh.normals[v[1]];
    ++ends;
  }
  return ends == 2 ? std::min(least, standsOut(e, middle, normal)) : least;
}

float RingTest::alpha(std::uint32_t e) const {
  const Edge& edge = topology.edges()[e];
  if (edge.boundary || edge.isFeature() || curves.curves[e] == CurveOffsets{}) return 0.0f;
  const std::array<std::uint32_t, 2>& ends = curves.vertices[e][0];
  const vec3 w = towardsEye(view, 0.5f * (mesh.positions[ends[0]] + mesh.positions[ends[1]]));
  const float length2 = dot(w, w);
  const float product =
      dot(w, curves.faceNormals[edge.faces[0].triangle]) * dot(w, curves.faceNormals[edge.faces[1].triangle]);
  if (!(product < kBeta * length2)) return 0.0f;
  const float alpha = silhouettenessOf(product / length2, kBeta) * exposed(e, edge.faces[0]);
  return alpha > 0.0f ? alpha * exposed(e, edge.faces[1]) : 0.0f;
}

}  // namespace limn::silhouette
