#include "silhouette/ring.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "silhouette/silhouetteness.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

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

// How far the middle of the edge, curved or straight, is outside the tangent plane at a place on the contour: 0 … 1.
float RingTest::standsOut(const Middle& edge, const vec3& place, const vec3& unitNormal) const {
  const float chord = dot(edge.chord - place, unitNormal) * edge.scale;
  const float curve = chord + dot(edge.offset, unitNormal) * edge.scale;
  return std::max(smoothStep(kChordBehind, kChordOut, chord), smoothStep(kCurveBehind, kCurveOut, curve));
}

// How much of the edge the viewer sees beside the segment in a triangle at it; 1 where there is none.
float RingTest::besideSegment(const Middle& edge, const Side& face) const {
  const std::uint32_t* corner = &mesh.indices[3 * face.triangle];
  if (visible[corner[0]] == visible[corner[1]] && visible[corner[1]] == visible[corner[2]]) return 1.0f;
  vec3 middle(0.0f), normal(0.0f);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t other = topology.sideEdges()[3 * face.triangle + k];
    const EdgeLink& link = curves.links[other];
    const Side& second = topology.edges()[other].faces[1];
    const std::size_t own = link.seam && second.triangle == face.triangle && second.side == k ? 1 : 0;
    const std::array<std::uint32_t, 2>& v = curves.vertices[other][own];
    if (visible[v[0]] == visible[v[1]]) continue;
    if (!link.bridged) return 1.0f;
    const SilhouettePoint& point = points[pointsOf[other]][own];
    middle += 0.5f * point.end.place;
    normal += point.normal;
  }
  const float size2 = dot(normal, normal);
  return size2 > 0.0f ? standsOut(edge, middle, normal / std::sqrt(size2)) : 1.0f;
}

// And beside the corners near the contour, which are all that is left of a segment that has shrunk into one.
float RingTest::besideCorners(const Middle& edge, const Side& face) const {
  float least = 1.0f;
  for (std::uint32_t k = 0; k < 3 && least > 0.0f; ++k) {
    const std::uint32_t corner = mesh.indices[3 * face.triangle + k];
    const float covered = coverOf(corner);
    if (!(covered > 0.0f)) continue;
    const float out = standsOut(edge, mesh.positions[corner], mesh.normals[corner]);
    least = std::min(least, 1.0f - covered * (1.0f - out));
  }
  return least;
}

float RingTest::silhouetteness(std::uint32_t e) const {
  const EdgeLink& link = curves.links[e];
  const vec3 w = towardsEye(view, 0.5f * (mesh.positions[link.ends[0]] + mesh.positions[link.ends[1]]));
  const float length2 = dot(w, w);
  const float product = dot(w, curves.faceNormals[link.faces[0]]) * dot(w, curves.faceNormals[link.faces[1]]);
  return product < kBeta * length2 ? silhouettenessOf(product / length2, kBeta) : 0.0f;
}

float RingTest::alpha(std::uint32_t e, float silhouetteness) const {
  const EdgeLink& link = curves.links[e];
  const vec3 &p = mesh.positions[link.ends[0]], &q = mesh.positions[link.ends[1]];
  const Middle middle{0.5f * (p + q), curveOffset(curves.curves[e], 0.5f), 1.0f / glm::length(q - p)};
  // The segments first: beside them nearly every edge of a smooth shape is hidden.
  const std::array<Side, 2>& faces = topology.edges()[e].faces;
  const float first = besideSegment(middle, faces[0]);
  if (!(first > 0.0f)) return 0.0f;
  const float second = besideSegment(middle, faces[1]);
  if (!(second > 0.0f)) return 0.0f;
  return silhouetteness * std::min(first, besideCorners(middle, faces[0])) *
         std::min(second, besideCorners(middle, faces[1]));
}

}  // namespace limn::silhouette
