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
constexpr float kFacing = 0.2f;  // sine of the angle from the contour at which an end's fade is over
constexpr float kStaysBehind =
    0.01f;  // edge lengths by which the curve's middle must pass the segment's to count
constexpr float kStandsOut = 0.06f;  // and to count wholly

}  // namespace

// The unit normal's facing, independent of the distance.
float RingTest::facingOf(std::uint32_t vertex) const {
  const vec3 v = towardsEye(view, mesh.positions[vertex]);
  const float length2 = dot(v, v);
  return length2 > 0.0f ? dot(v, mesh.normals[vertex]) / std::sqrt(length2) : 0.0f;
}

// How far the middle of the edge's curve lies outside the middle of the segment in a triangle beside it, by the
// normal there; 0 … 1, and 1 where that triangle has none.
float RingTest::standsOut(std::uint32_t e, const Side& face) const {
  const std::uint32_t first = 3 * face.triangle;
  const std::uint32_t opposite = mesh.indices[first + (face.side + 2) % 3];
  const std::array<std::uint32_t, 2>& ends = curves.vertices[e][0];
  if (visible[opposite] == visible[ends[0]]) return 1.0f;
  vec3 middle(0.0f), normal(0.0f);
  for (std::uint32_t turn = 1; turn < 3; ++turn) {
    const std::uint32_t side = first + (face.side + turn) % 3, other = topology.sideEdges()[side];
    const Edge& edge = topology.edges()[other];
    const std::size_t own = edge.faces[0].triangle == face.triangle && edge.faces[0].side == side % 3 ? 0 : 1;
    const std::array<std::uint32_t, 2>& v = curves.vertices[other][own];
    if (edge.nonManifold || visible[v[0]] == visible[v[1]]) return 1.0f;
    const vec3 &p = mesh.positions[v[0]], &q = mesh.positions[v[1]];
    const float t = contourParameter(view, {p, q}, {mesh.normals[v[0]], mesh.normals[v[1]]});
    middle += 0.5f * curvePoint(p, q, curves.curves[other], t);
    normal += (1.0f - t) * mesh.normals[v[0]] + t * mesh.normals[v[1]];
  }
  const float size2 = dot(normal, normal);
  if (!(size2 > 0.0f)) return 1.0f;
  const vec3 &p = mesh.positions[ends[0]], &q = mesh.positions[ends[1]];
  const float height = dot(curvePoint(p, q, curves.curves[e], 0.5f) - middle, normal) / std::sqrt(size2);
  return smoothStep(kStaysBehind, kStandsOut, height / glm::length(q - p));
}

float RingTest::alpha(std::uint32_t e) const {
  const Edge& edge = topology.edges()[e];
  if (edge.boundary || edge.isFeature() || curves.curves[e] == CurveOffsets{}) return 0.0f;
  const EdgeVertices& v = curves.vertices[e];
  const vec3 w = towardsEye(view, 0.5f * (mesh.positions[v[0][0]] + mesh.positions[v[0][1]]));
  const float length2 = dot(w, w);
  const float product =
      dot(w, curves.faceNormals[edge.faces[0].triangle]) * dot(w, curves.faceNormals[edge.faces[1].triangle]);
  if (!(product < kBeta * length2)) return 0.0f;
  if (visible[v[0][0]] != visible[v[0][1]] || visible[v[1][0]] != visible[v[1][1]]) return 0.0f;
  const float nearest = std::min(std::abs(facingOf(v[0][0])), std::abs(facingOf(v[0][1])));
  const float alpha = silhouettenessOf(product / length2, kBeta) * smoothStep(0.0f, kFacing, nearest);
  if (!(alpha > 0.0f)) return 0.0f;
  return alpha * standsOut(e, edge.faces[0]) * standsOut(e, edge.faces[1]);
}

}  // namespace limn::silhouette
