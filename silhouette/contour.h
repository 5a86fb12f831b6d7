// Where the contour of the smooth shape crosses an edge, and the curve that joins two such points.
//
// Based on: L. Wang, C. Tu, W. Wang, X. Meng, B. Chan, D. Yan, "Silhouette Smoothing for Real-Time Rendering
// of Mesh Surfaces", (2)-(7). Differs in: the normal along a bridge is a parabola that in the middle is perpendicular to
// the bridge, not linear (on a torus of 576 triangles the linear one is up to 2.4 degrees off in the middle of an edge, this
// one 1); bridges and segments are kept as what they add to the straight line
// (edge_curves.h); the quadratic is solved without cancellation, and bounded so that its root moves continuously through
// the ends of the edge; a polyline's inner vertices lie outside the curve instead of on it, which leaves 3/8 of
// the mean error for the same number of vertices.
#pragma once

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>

#include "silhouette/edge_curves.h"
#include "silhouette/mesh.h"
#include "silhouette/pixel_bound.h"

namespace limn::silhouette {

/// From a point towards the eye, not unit: o - x, or -d.
inline glm::vec3 towardsEye(const View& view, const glm::vec3& x) {
  return view.projection.perspective ? view.eye - x : -view.direction;
}

/// g = ⟨n, v(p)⟩. A vertex is visible when g >= 0.
inline float facing(const View& view, const glm::vec3& p, const glm::vec3& n) {
  const glm::vec3 v = towardsEye(view, p);
  return n.x * v.x + n.y * v.y + n.z * v.z;
}

/// The root u in [0, 1] of (1-u)² a + u(1-u) b + u² c, for a > 0 >= c or a <= 0 < c. Continuous up to both ends;
/// relative error of u and of 1-u a few ulp.
double contourRoot(double a, double b, double c);

/// w of the normal (1-u) n[0] + u n[1] - 4 u (1-u) w along the curve with offsets d from p[0] to p[1]: what the linear one
/// has in the direction of the curve in its middle. Not longer than the mean of the normals.
glm::vec3 normalTurn(const std::array<glm::vec3, 2>& p, const std::array<glm::vec3, 2>& n,
                     const CurveOffsets& d);

/// Squares of lengths below this tell no direction.
inline constexpr float kLeastSquare = 1e-37f;

/// The normal that a segment has at u, not unit: with half of w. The whole would take the outlines of tubes nearer still
/// (trefoil-480: 84 % of the error removed), but the segments then bend so much that knots pop by more than the tolerance.
inline glm::vec3 bridgeNormal(const std::array<glm::vec3, 2>& n, const glm::vec3& turn, float u) {
  const float s = 1.0f - u;
  return s * n[0] + u * n[1] - (2.0f * s * u) * turn;
}

/// Of a quadratic's middle coefficient, in those of its ends: where it is as in (1-u) a + u c it lies between them.
inline constexpr double kSteepest = 2.0;

/// Where on the edge from p[0] to p[1], whose ends differ in visibility, that normal is perpendicular to the direction of
/// view (linear; to the one of the edge's middle for w): in [0, 1], whatever the numbers. That is a quadratic, whose middle
/// coefficient is bounded by kSteepest of those at the ends: beyond, it has a second root near an end, and where that end
/// turns the point would jump from one root to the other. It is bounded at one in twenty-five points of the trefoil, at a
/// quarter of those of scans.
float contourParameter(const View& view, const std::array<glm::vec3, 2>& p, const std::array<glm::vec3, 2>& n,
                       const glm::vec3& turn);

/// An end of a silhouette segment.
struct SegmentEnd {
  glm::vec3 place;
  glm::vec3 normal;  ///< unit
  float trust = 1;   ///< of the bridge it lies on, there
};

/// Where a silhouette curve crosses an edge, in one of the edge's faces.
struct SilhouettePoint {
  bool exists = false;
  float parameter = 0;     ///< along the edge, from point[0] to point[1]
  glm::vec3 normal{0.0f};  ///< bridgeNormal()
  SegmentEnd end{};
};
using SilhouettePoints = std::array<SilhouettePoint, 2>;  ///< per face

/// The segment's curve: that of an edge between its ends, bent as far as the bridges at its ends are trusted and, if
/// `robust`, neither end much more than the other.
CurveOffsets segmentCurve(const SegmentEnd& a, const SegmentEnd& b, bool robust);

/// Second derivative of curvePoint() by t.
inline glm::vec3 curveSecondDerivative(const CurveOffsets& d, float t) {
  return 6.0f * ((3.0f * t - 2.0f) * d[0] + (1.0f - 3.0f * t) * d[1]);
}

/// How far outside the curve the inner vertices of its polyline lie, in sagittas of a step: with 3/4 the mean
/// distance is least (1/4 of a sagitta instead of 2/3) and the largest is 3/4 of that of vertices on the curve.
inline constexpr float kOutside = 0.75f;

/// Vertex k of the polyline of n steps, 0 < k < n. The sagitta of a step is S''/(8 n²).
inline glm::vec3 polylineVertex(const glm::vec3& p, const glm::vec3& q, const CurveOffsets& d, int k, int n) {
  const auto steps = static_cast<float>(n);
  const float t = static_cast<float>(k) / steps;
  return curvePoint(p, q, d, t) - (kOutside / (8.0f * steps * steps)) * curveSecondDerivative(d, t);
}

/// The number of such steps for a distance between curve and chord. It stays within the tolerance with a quarter
/// to spare, so that the polyline moves by no more than the tolerance where the number changes: from 3/4 outside at
/// n steps to 1/4 inside at n + 1, or from a chord, all inside, to 3/16 outside at two.
inline int polylineSteps(float chordError, float tolerance, bool& capped) {
  if (chordError <= tolerance / (1.0f + 0.25f * kOutside)) return 1;
  return std::max(2, segmentsFor({chordError, chordError}, tolerance, capped));
}

}  // namespace limn::silhouette
