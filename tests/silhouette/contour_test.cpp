#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "raster/base/elementary.h"
#include "shapes.h"
#include "silhouette/contour.h"
#include "silhouette/crossed_edges.h"
#include "silhouette/feature_curves.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

// The root by bisection in extended precision: slow and obviously right. The form is not positive at the visible
// end and positive at the other.
long double bisected(long double a, long double b, long double c) {
  long double low = 0.0L, high = 1.0L;
  for (int step = 0; step < 200; ++step) {
    const long double u = 0.5L * (low + high), v = 1.0L - u;
    const bool positive = v * v * a + u * v * b + u * u * c > 0.0L;
    (positive == (a > 0.0L) ? low : high) = u;
  }
  return 0.5L * (low + high);
}

TEST(Contour, RootAgreesWithBisectionInExtendedPrecision) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-12.0, 12.0), sign(-1.0, 1.0);
  const auto magnitude = [&] { return power(10.0, exponent(random)); };
  for (int k = 0; k < 5000; ++k) {
    double a = magnitude(), b = std::copysign(magnitude(), sign(random)), c = -magnitude();
    if (sign(random) < 0.0) a = -a, c = -c;
    const double u = contourRoot(a, b, c);
    const long double exact = bisected(a, b, c);
    EXPECT_LE(std::abs(static_cast<double>(u - exact)),
              1e-14 * static_cast<double>(std::min(exact, 1.0L - exact)) + 3e-16)
        << a << ' ' << b << ' ' << c;
  }
}

TEST(Contour, RootIsContinuousAtTheEndsOfAnEdge) {
  for (const double b : {-3.0, -1e-9, 0.0, 1e-9, 3.0}) {
    // a → 0 from the visible side reaches what a = 0 gives, c likewise.
    EXPECT_NEAR(contourRoot(0.0, b, 1.0), contourRoot(-1e-18, b, 1.0), 2e-9) << b;
    EXPECT_NEAR(contourRoot(1.0, b, 0.0), contourRoot(1.0, b, -1e-18), 2e-9) << b;
  }
  EXPECT_EQ(contourRoot(1.0, 0.0, 0.0), 1.0);
  EXPECT_EQ(contourRoot(0.0, 0.0, 1.0), 0.0);
}

TEST(Contour, ParameterIsWhereTheNormalTurnsFromTheEye) {
  // A unit circle's chord; seen along x its contour point is the top, in the middle of the arc.
  const float s = std::sqrt(0.5f);
  const std::array<vec3, 2> ends{vec3(-s, s, 0), vec3(s, s, 0)};
  EXPECT_FLOAT_EQ(contourParameter(orthographicAlong({1, 0, 0}), ends, ends, vec3(0.0f)), 0.5f);
  // From a finite distance the contour point comes nearer to the eye.
  const float near = contourParameter(perspectiveFrom({-4, 0, 0}), ends, ends, vec3(0.0f));
  EXPECT_GT(near, 0.0f);
  EXPECT_LT(near, 0.5f);
}

// Seen along x from ever smaller heights of the second end, the contour goes into that end and does not stop before it at
// the root of a parabola that turns back there.
TEST(Contour, ParameterGoesIntoAnEndWhoseNormalBendsBack) {
  const std::array<vec3, 2> p{vec3(0, 0, 0), vec3(0, 1, 0)};
  const View view = orthographicAlong({-1, 0, 0});
  const vec3 turn(0.9f, 0.0f, 0.0f);  // the parabola has turned from 0.28 on
  const auto parameter = [&](float height) {
    return contourParameter(view, p, {vec3(1, 0, 0), vec3(height, 1, 0)}, turn);
  };
  float last = 0.0f;
  for (int step = 0; step < 20; ++step) {
    const float height = -std::ldexp(0.5f, -2 * step), u = parameter(height);
    EXPECT_GT(u, last) << height;
    // (1-u)² = |c| to first order.
    EXPECT_LE(1.0f - u, 2.0f * std::sqrt(-height)) << height;
    last = u;
  }
  EXPECT_GT(last, 0.9999f);
}

TEST(Contour, NormalIsPerpendicularToTheBridgeInItsMiddle) {
  // An edge across a cylinder about z, whose normals are unequally far from the middle of the circle they turn on.
  const SinCos end = sinCosDegrees(35.0);
  const std::array<vec3, 2> p{vec3(1, 0, 0), vec3(end.cos, end.sin, 0.6)},
      n{p[0], vec3(end.cos, end.sin, 0.2f)};
  const CurveOffsets d =
      edgeCurve(p[0], p[1], {{n[0], n[0]}, false}, {{n[1], n[1]}, false}, {Tangents::kGeodesicArc, false});
  const vec3 turn = normalTurn(p, n, d);
  const vec3 along = curvePoint(p[0], p[1], d, 0.501f) - curvePoint(p[0], p[1], d, 0.499f);
  EXPECT_GT(glm::length(turn), 0.05f);
  EXPECT_LT(std::abs(glm::dot(0.5f * (n[0] + n[1]) - turn, glm::normalize(along))), 1e-4f);
  // Such a normal, along the straight line of view towards the middle, is where the contour is.
  const View view = orthographicAlong({0.3f, -0.9f, 0.1f});
  ASSERT_NE(facing(view, p[0], n[0]) >= 0.0f, facing(view, p[1], n[1]) >= 0.0f);
  const float u = contourParameter(view, p, n, turn);
  const vec3 normal = (1.0f - u) * n[0] + u * n[1] - (4.0f * u * (1.0f - u)) * turn;
  EXPECT_LT(std::abs(facing(view, p[0], normal)), 1e-6f);
  // No length, no direction: the linear normal.
  EXPECT_EQ(normalTurn({p[0], p[0]}, n, {}), vec3(0.0f));
}

// With α the samples of a crossed edge grow from the line over its silhouette point to its curve.
TEST(Contour, SamplesOfACrossedEdgeBeginOnWhatItShowsWithoutThem) {
  const EdgeCurve bridge{{vec3(0, 0, 0), vec3(4, 0, 0)}, {vec3(0.3f, 1, 0), vec3(-0.2f, 2, 0.5f)}};
  const float peak = 0.3f;
  const vec3 top = bridge.point(peak);
  for (std::uint32_t k = 1; k < 8; ++k) {
    const float t = static_cast<float>(k) / 8.0f;
    const vec3 over = t < peak ? t / peak * top : top + (t - peak) / (1.0f - peak) * (bridge.ends[1] - top);
    const auto sample = [&](float alpha) { return ShownCurve{bridge, alpha, peak}.sample(k, 8); };
    EXPECT_LT(glm::distance(sample(1e-7f), over), 2e-6f) << k;
    EXPECT_LT(glm::distance(sample(0.5f), 0.5f * (over + bridge.sample(k, 8))), 2e-6f) << k;
    EXPECT_EQ(sample(1.0f), bridge.sample(k, 8));
    // Without a point, α of the curve.
    const EdgeCurve half{bridge.ends, {0.5f * bridge.offsets[0], 0.5f * bridge.offsets[1]}};
    EXPECT_EQ((ShownCurve{bridge, 0.5f, 0.0f}.sample(k, 8)), half.sample(k, 8));
  }
}

TEST(Contour, PolylineOutsideTheCurveHalvesTheError) {
  // An arc of 40 degrees of the unit circle; polylines of n steps with vertices on and outside the curve.
  const SinCos half = sinCosDegrees(20.0);
  const vec3 p(-half.sin, half.cos, 0), q(half.sin, half.cos, 0);
  const CurveOffsets d = edgeCurve(p, q, {{p, p}, false}, {{q, q}, false}, {Tangents::kCircular, false});
  const float sagitta = 1.0f - static_cast<float>(half.cos);
  EXPECT_NEAR(curvePoint(p, q, d, 0.5f).y, 1.0f, 2e-4f);
  for (const int n : {2, 4, 8}) {
    const auto steps = static_cast<float>(n);
    float most = 0.0f;
    double mean = 0.0;
    constexpr int kPoints = 4000;
    for (int i = 0; i <= kPoints; ++i) {
      const float t = static_cast<float>(i) / kPoints, along = t * steps;
      const int k = std::min(n - 1, static_cast<int>(along));
      const vec3 a = k == 0 ? p : polylineVertex(p, q, d, k, n);
      const vec3 b = k + 1 == n ? q : polylineVertex(p, q, d, k + 1, n);
      const float w = along - static_cast<float>(k);
      const float error = glm::length((1.0f - w) * a + w * b - curvePoint(p, q, d, t));
      most = std::max(most, error);
      mean += error / kPoints;
    }
    const float step = sagitta / (steps * steps);
    EXPECT_LE(most, kOutside * step * 1.03f) << n;
    EXPECT_LT(mean, (n == 2 ? 0.45 : 0.38) * static_cast<double>(step)) << n;  // on the curve: 2/3
  }
}

TEST(FeatureCurves, TangentIsTheCircles) {
  // Three points of a circle with unequal chords; the tangent at the middle one is perpendicular to its radius.
  const SinCos first = sinCosDegrees(-50.0), last = sinCosDegrees(17.0);
  const vec3 a(first.cos, first.sin, 0.3), b(1, 0, 0.3), c(last.cos, last.sin, 0.3);
  const vec3 tangent = circleTangent(b - a, c - b);
  EXPECT_NEAR(tangent.x / glm::length(tangent), 0.0f, 1e-6f);
  EXPECT_GT(tangent.y, 0.0f);
}

std::vector<CurveOffsets> featureCurves(const Shape& shape, const Topology& topology) {
  Workers workers(1);
  std::vector<CurveOffsets> curves(topology.edges().size());
  computeFeatureCurves(shape.mesh(), topology, Crew(workers), curves);
  return curves;
}

TEST(FeatureCurves, RimsOfACylinderAreRound) {
  const Shape shape = cylinder(16);
  const Topology topology(shape.mesh());
  const std::vector<CurveOffsets> curves = featureCurves(shape, topology);
  std::size_t rims = 0;
  for (std::size_t e = 0; e < curves.size(); ++e) {
    const std::array<std::uint32_t, 2> v = edgeVertices(shape.mesh(), topology.edges()[e])[0];
    const vec3 &p = shape.positions[v[0]], &q = shape.positions[v[1]];
    if (!topology.edges()[e].isFeature()) {
      EXPECT_EQ(curves[e][0], vec3(0.0f));
      continue;
    }
    ++rims;
    for (const float t : {0.25f, 0.5f, 0.75f}) {
      const vec3 point = curvePoint(p, q, curves[e], t);
      EXPECT_NEAR(glm::length(glm::vec2(point)), 1.0f, 2e-5f);
      EXPECT_EQ(point.z, p.z);
    }
  }
  EXPECT_EQ(rims, 32u);
}

TEST(FeatureCurves, CornersAndSingleEdgesStayStraight) {
  const Shape shape = cube();
  const Topology topology(shape.mesh());
  for (const CurveOffsets& curve : featureCurves(shape, topology)) EXPECT_EQ(curve, CurveOffsets{});
}

}  // namespace
}  // namespace limn::silhouette::test
