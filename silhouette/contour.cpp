#include "silhouette/contour.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "raster/base/check.h"

namespace limn::silhouette {
namespace {

constexpr float kLimit = 1.5f;  // of an end's tilt to the other's

}  // namespace

// In τ = u/(1-u) it is c τ² + b τ + a = 0 with a c <= 0. q = -(b + sgn(b) √(b² - 4ac))/2 adds numbers of one
// sign; the roots are q/c and a/q, and the signs say which is the one that is not negative.
double contourRoot(double a, double b, double c) {
  LIMN_ASSERT((a > 0.0) != (c > 0.0), a, b, c);
  const double root = std::sqrt(b * b - 4.0 * a * c);
  const double q = -0.5 * (b < 0.0 ? b - root : b + root);
  const bool first = (b < 0.0) == (c > 0.0);
  const double numerator = std::abs(first ? q : a), denominator = std::abs(first ? c : q);
  if (denominator == 0.0) return first ? 1.0 : 0.0;
  return numerator / (numerator + denominator);
}

glm::vec3 normalTurn(const std::array<glm::vec3, 2>& p, const std::array<glm::vec3, 2>& n,
                     const CurveOffsets& d) {
  const glm::vec3 along = (p[1] - p[0]) + 0.75f * (d[1] - d[0]);
  const float length2 = glm::dot(along, along);
  if (!(length2 >= kLeastSquare)) return glm::vec3(0.0f);
  return (0.5f * glm::dot(n[0] + n[1], along) / length2) * along;
}

// The middle control point of the normal's parabola is (n_0 + n_1)/2 - 2 w: so are those of the two products.
float contourParameter(const View& view, const std::array<glm::vec3, 2>& p, const std::array<glm::vec3, 2>& n,
                       const glm::vec3& turn) {
  // With D = x - o; its ends' values are those that decided visibility, so the signs are as they must be.
  const double a = -facing(view, p[0], n[0]), c = -facing(view, p[1], n[1]);
  const glm::dvec3 v1(towardsEye(view, p[0])), v2(towardsEye(view, p[1]));
  const glm::dvec3 n1(n[0] - 2.0f * turn), n2(n[1] - 2.0f * turn);
  const double free = -(glm::dot(v1, n2) + glm::dot(v2, n1));
  if (!std::isfinite((a - c) + free)) return 0.5f;  // nor are places, normals or the curve: any will do
  const double b = std::clamp(free, kSteepest * std::min(a, c), kSteepest * std::max(a, c));
  return static_cast<float>(contourRoot(a, b, c));
}

CurveOffsets segmentCurve(const SegmentEnd& a, const SegmentEnd& b, bool robust) {
  const CurveStyle style{Tangents::kGeodesicArc, robust};
  CurveOffsets offsets =
      edgeCurve(a.place, b.place, {{a.normal, a.normal}, false}, {{b.normal, b.normal}, false}, style);
  if (!robust) return offsets;
  const glm::vec3 chord = b.place - a.place;
  const float tiltA = -glm::dot(chord, a.normal), tiltB = glm::dot(chord, b.normal);
  offsets[0] *= a.trust * endLimit(kLimit, tiltA, tiltB);
  offsets[1] *= b.trust * endLimit(kLimit, tiltB, tiltA);
  return offsets;
}

}  // namespace limn::silhouette
