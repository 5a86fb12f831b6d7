// The smooth curve of every edge: view-independent, computed once for a rigid mesh and once per frame for a
// moving one.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, (4)-(8); L. Wang et al.,
// "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", for the length of the circular tangent at an angle θ to
// the edge e, 2 |e| / (1 + cos θ); M. Sabin's geodesic-like ends as quoted by the former. Differs in: a curve is kept as what it adds
// to the straight edge, d_ij = c_ij - l_ij, which is exactly 0 where the normals are orthogonal to the edge
// (linear precision to the last bit) and loses no digits far from the origin. Silhouette curves take geodesic-like
// directions with circular lengths: across a tube or a saddle a curve in the surface leaves the plane of its chord and
// normal, and the circular tangents alone, which do not, leave it 0.2 pixels off where these leave 0.07 (diagonals of a
// torus of 576 triangles, 1024 pixels high); on a circle both are the same.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "silhouette/method.h"
#include "silhouette/robust_ends.h"

namespace limn::silhouette {

/// d_ij at point[0] and d_ji at point[1] of an edge.
using CurveOffsets = std::array<glm::vec3, 2>;

/// How curves are made.
struct CurveStyle {
  Tangents tangents = Tangents::kProjected;
  bool robust = false;

  bool operator==(const CurveStyle&) const = default;
};

/// An edge end as the mesh has it: the normals of the two faces, the same one twice where they share it.
struct EdgeEnd {
  glm::vec3 normal[2];
  bool feature = false;
};

/// The curve of one edge from p_i to p_j.
CurveOffsets edgeCurve(const glm::vec3& pi, const glm::vec3& pj, const EdgeEnd& atI, const EdgeEnd& atJ,
                       const CurveStyle& style);

/// The curves of all edges; zero for non-manifold ones. `robust` is prepared and scales the ends when the style says so.
void computeEdgeCurves(const Mesh& mesh, const Topology& topology, const CurveStyle& style, const Crew& crew,
                       RobustEnds& robust, std::vector<CurveOffsets>& curves);

/// Those of fitted edges instead, 0 at non-manifold ones, and what (F2) adds in every triangle (fitted_curves.h).
void placeFittedCurves(const Mesh& mesh, const Topology& topology, const FittedCurves& fitted,
                       const Crew& crew, std::vector<CurveOffsets>& curves, std::vector<glm::vec3>& centers);

/// 0 below `low`, 1 above `high`, and a smooth cubic between.
inline float smoothStep(float low, float high, float x) {
  const float t = x <= low ? 0.0f : x >= high ? 1.0f : (x - low) / (high - low);
  return t * t * (3.0f - 2.0f * t);
}

/// What the curve adds to the straight edge at t.
inline glm::vec3 curveOffset(const CurveOffsets& d, float t) {
  const float s = 1.0f - t;
  return 3.0f * s * t * (s * d[0] + t * d[1]);
}

/// The point at t of the cubic with inner offsets d from p to q.
inline glm::vec3 curvePoint(const glm::vec3& p, const glm::vec3& q, const CurveOffsets& d, float t) {
  return (1.0f - t) * p + t * q + curveOffset(d, t);
}

}  // namespace limn::silhouette
