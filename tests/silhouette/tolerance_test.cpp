// The guarantee: at tolerance e every point of an edge's curve projects to within e pixels of its polyline,
// and back; checked against dense samples, in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "shapes.h"
#include "silhouette/pixel_bound.h"

namespace limn::silhouette::test {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

dvec2 project(const View& view, const dvec3& p) {
  const dvec3 v(glm::dmat4(view.modelToView) * glm::dvec4(p, 1.0));
  const double w = view.projection.perspective ? -v.z : 1.0;
  return dvec2(v.x * view.projection.pixelsX, v.y * view.projection.pixelsY) / w;
}

double distanceToSegment(const dvec2& p, const dvec2& a, const dvec2& b) {
  const dvec2 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0.0 ? std::fmin(1.0, std::fmax(0.0, glm::dot(p - a, ab) / length2)) : 0.0;
  return glm::length(p - (a + t * ab));
}

dvec3 exactCurve(const vec3& p, const vec3& q, const CurveOffsets& d, double t) {
  const double s = 1.0 - t;
  return s * dvec3(p) + t * dvec3(q) + 3.0 * s * t * (s * dvec3(d[0]) + t * dvec3(d[1]));
}

// The larger of the two one-sided distances between a curve and its polyline of n equal steps, in pixels.
double pixelError(const View& view, const vec3& p, const vec3& q, const CurveOffsets& d, int n) {
  std::vector<dvec2> polyline, curve;
  for (int k = 0; k <= n; ++k)
    polyline.push_back(project(view, exactCurve(p, q, d, static_cast<double>(k) / n)));
  constexpr int kSamples = 300;
  for (int k = 0; k <= kSamples; ++k)
    curve.push_back(project(view, exactCurve(p, q, d, static_cast<double>(k) / kSamples)));
  double largest = 0.0;
  for (const dvec2& point : curve) {
    double nearest = 1e300;
    for (int k = 0; k < n; ++k)
      nearest = std::fmin(nearest, distanceToSegment(point, polyline[k], polyline[k + 1]));
    largest = std::fmax(largest, nearest);
  }
  for (int k = 0; k < n; ++k) {
    for (int i = 1; i < 16; ++i) {
      const dvec2 point = polyline[k] + (polyline[k + 1] - polyline[k]) * (i / 16.0);
      double nearest = 1e300;
      for (int j = 0; j < kSamples; ++j)
        nearest = std::fmin(nearest, distanceToSegment(point, curve[j], curve[j + 1]));
      largest = std::fmax(largest, nearest);
    }
  }
  return largest;
}

struct Random {
  std::mt19937 engine;
  float next() { return static_cast<float>(engine() % 2000001) / 1000000.0f - 1.0f; }
  vec3 vector() { return {next(), next(), next()}; }
};

class ToleranceOf : public testing::TestWithParam<bool> {};

// Curves of every bend at every depth ratio up to a hundred.
TEST_P(ToleranceOf, RandomCurves) {
  Random random{std::mt19937(GetParam() ? 5 : 6)};
  double tightest = 0.0;
  for (int k = 0; k < 600; ++k) {
    const float nearest = std::exp2(-7.0f * std::fabs(random.next()));
    const View view =
        GetParam() ? perspectiveFrom({0, 0, 1.0f + nearest}, 0.001f) : orthographicAlong({0, 0, -1});
    vec3 p = random.vector(), q = random.vector();
    if (k % 3 == 0) p = vec3(0.1f, 0.2f, 1.0f);  // right before the eye
    CurveOffsets d = {0.3f * random.vector(), 0.3f * random.vector()};
    d[0].z = -std::fabs(d[0].z);  // stays beyond the near plane
    d[1].z = -std::fabs(d[1].z);
    const float tolerance = 0.25f * std::exp2(4.0f * random.next());
    bool capped = false;
    const int n = segmentsFor(PixelBound(view).curveError(p, q, d), tolerance, capped);
    if (capped) continue;
    const double error = pixelError(view, p, q, d, n);
    ASSERT_LE(error, tolerance * 1.0001 + 1e-4) << "case " << k << ", " << n << " segments";
    if (n > 1) tightest = std::fmax(tightest, error / tolerance);
  }
  EXPECT_GT(tightest, GetParam() ? 0.7 : 0.9);  // and the bound wastes little
}

INSTANTIATE_TEST_SUITE_P(Projections, ToleranceOf, testing::Bool(), [](const auto& instance) {
  return instance.param ? "Perspective" : "Orthographic";
});

TEST(Tolerance, CapsAndExtremes) {
  bool capped = false;
  EXPECT_EQ(segmentsFor({0.0f, 0.0f}, 0.0f, capped), 1);
  EXPECT_FALSE(capped);
  EXPECT_EQ(segmentsFor({1.0f, 1.0f}, 0.0f, capped), kMaxSegments);
  EXPECT_TRUE(capped);
  EXPECT_EQ(segmentsFor({1.0f, 1.0f}, 1.0f, capped), 1);
  EXPECT_EQ(segmentsFor({4.001f, 4.001f}, 1.0f, capped), 3);
  EXPECT_EQ(segmentsFor({4.001f, 0.9f}, 1.0f, capped), 1);
  EXPECT_EQ(segmentsFor({4.001f, 3.0f}, 1.0f, capped), 2);
}

// The drawn outline of a refined sphere comes to the sphere's as the tolerance tightens: its vertices lie on
// it within the error of a cubic patch, and no triangle that the contour crosses strays from it by much more
// than the tolerance.
TEST(Tolerance, RefinedSphereTendsToTheSphere) {
  const Shape sphere = icosphere(2);
  Workers workers(1);
  const Topology topology(sphere.mesh());
  Refiner refiner(sphere.mesh(), topology, workers);
  Parameters parameters;
  parameters.tangents = Tangents::kCircular;
  parameters.silhouetteness = Silhouetteness::kContour;
  parameters.beta = 0.25f;  // whatever the contour may reach is wholly smooth
  double last = 1e300;
  for (const float tolerance : {4.0f, 1.0f, 0.25f, 0.0625f}) {
    parameters.tolerance = tolerance;
    double largest = 0.0, unit = 0.0;
    for (const View& view : someViews(5.0f)) {
      RefinedStream stream;
      refiner.refine(view, parameters, stream);
      const std::vector<vec3> drawn = drawnTriangles(sphere.mesh(), stream);
      unit = view.projection.perspective ? view.projection.pixelsX / 5.0 : view.projection.pixelsX;
      for (std::size_t t = 0; t < drawn.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) {  // a side that the contour of the sphere crosses
          const vec3 &a = drawn[t + k], &b = drawn[t + (k + 1) % 3];
          const auto facing = [&](const vec3& p) {
            return dot(p, view.projection.perspective ? view.eye - p : -view.direction);
          };
          if (facing(a) * facing(b) > 0.0f) continue;
          largest = std::max(largest, (1.0 - glm::length(0.5f * (a + b))) * unit);
        }
      }
    }
    // The inside follows an estimate, not a bound; the second term is the cubic patch's own error.
    EXPECT_LT(largest, 1.5 * tolerance + 3e-4 * unit) << tolerance;
    EXPECT_LE(largest, last);
    last = largest;
  }
}

}  // namespace
}  // namespace limn::silhouette::test
