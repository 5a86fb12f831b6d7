// Analytic truths about curves and patches.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "shapes.h"
#include "silhouette/edge_curves.h"
#include "silhouette/patch.h"
#include "silhouette/silhouetteness.h"

namespace limn::silhouette::test {
namespace {

using glm::dot;
using glm::dvec3;
using glm::vec3;

struct Random {
  std::mt19937 engine;
  float next() { return static_cast<float>(engine() % 2000001) / 1000000.0f - 1.0f; }
  vec3 vector() { return {next(), next(), next()}; }
  vec3 unit() { return glm::normalize(vector() + vec3(0, 0, 1e-3f)); }
};

EdgeEnd smooth(const vec3& n) {
  return {{n, n}, false};
}

// The PN triangle of Vlachos et al. 2001 by their formulas, in double precision and by control points.
dvec3 pnTriangle(const std::array<dvec3, 3>& p, const std::array<dvec3, 3>& n, double u, double v, double w) {
  const auto edge = [&](int i, int j) { return (2.0 * p[i] + p[j] - dot(p[j] - p[i], n[i]) * n[i]) / 3.0; };
  const dvec3 b210 = edge(0, 1), b120 = edge(1, 0), b021 = edge(1, 2), b012 = edge(2, 1), b102 = edge(2, 0),
              b201 = edge(0, 2);
  const dvec3 E = (b210 + b120 + b021 + b012 + b102 + b201) / 6.0, V = (p[0] + p[1] + p[2]) / 3.0;
  const dvec3 b111 = E + (E - V) / 2.0;
  return p[0] * u * u * u + p[1] * v * v * v + p[2] * w * w * w + 3.0 * b210 * u * u * v +
         3.0 * b120 * u * v * v + 3.0 * b021 * v * v * w + 3.0 * b012 * v * w * w + 3.0 * b102 * w * w * u +
         3.0 * b201 * w * u * u + 6.0 * b111 * u * v * w;
}

TEST(Patch, WhollySmoothIsThePnTriangle) {
  Random random{std::mt19937(1)};
  for (int k = 0; k < 1000; ++k) {
    std::array<dvec3, 3> p, n;
    Patch patch;
    for (std::size_t i = 0; i < 3; ++i) {
      patch.corners[i] = random.vector();
      p[i] = dvec3(patch.corners[i]);
      n[i] = dvec3(random.unit());
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      patch.sides[i] =
          edgeCurve(patch.corners[i], patch.corners[j], smooth(vec3(n[i])), smooth(vec3(n[j])), {});
    }
    const float v = 0.5f * std::fabs(random.next()), w = 0.5f * std::fabs(random.next()), u = 1.0f - v - w;
    EXPECT_LT(glm::length(dvec3(patch.point(u, v, w)) - pnTriangle(p, n, u, v, w)), 2e-6) << "case " << k;
  }
}

TEST(Patch, WithoutOffsetsIsTheFlatTriangle) {
  Patch patch;
  patch.corners = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
  EXPECT_EQ(patch.offset(0.3f, 0.3f, 0.4f), vec3(0.0f));
}

constexpr std::array kAllTangents{Tangents::kProjected, Tangents::kCircular, Tangents::kGeodesic,
                                  Tangents::kGeodesicArc};

// Every kind of tangent leaves an edge alone whose normals are orthogonal to it.
TEST(EdgeCurve, LinearPrecision) {
  for (const Tangents tangents : kAllTangents) {
    const CurveOffsets d =
        edgeCurve({0, 0, 0}, {3, 0, 0}, smooth({0, 0, 1}), smooth({0, 1, 0}), {tangents, false});
    EXPECT_EQ(d[0], vec3(0.0f));
    EXPECT_EQ(d[1], vec3(0.0f));
    const EdgeEnd crease{{{0, 0, 1}, {0, 1, 0}}, true};
    const CurveOffsets f = edgeCurve({0, 0, 0}, {3, 0, 0}, crease, crease, {tangents, false});
    EXPECT_LT(glm::length(f[0]) + glm::length(f[1]), 1e-6f);
  }
}

// (5): tangents lie in the tangent planes of all faces at either end.
TEST(EdgeCurve, TangentsAreOrthogonalToTheNormals) {
  Random random{std::mt19937(2)};
  for (int k = 0; k < 1000; ++k) {
    const vec3 p = random.vector(), q = random.vector();
    for (const Tangents tangents : kAllTangents) {
      for (const bool feature : {false, true}) {
        const EdgeEnd end{{random.unit(), random.unit()}, feature}, other = smooth(random.unit());
        if (feature && glm::length(glm::cross(end.normal[0], end.normal[1])) < 0.05f) continue;
        const CurveOffsets d = edgeCurve(p, q, end, other, {tangents, false});
        const vec3 start = (q - p) / 3.0f + d[0], finish = (p - q) / 3.0f + d[1];
        EXPECT_LT(std::fabs(dot(start, end.normal[0])), 2e-6f) << k;
        if (feature) {
          EXPECT_LT(std::fabs(dot(start, end.normal[1])), 2e-6f) << k;
        }
        EXPECT_LT(std::fabs(dot(finish, other.normal[0])), 2e-6f) << k;
      }
    }
  }
}

// On a circle the error falls with the 4th power of the edge with (7), with the 6th with (L).
TEST(EdgeCurve, OrderOnACircle) {
  const auto error = [](double angle, Tangents tangents) {
    const vec3 p(1, 0, 0), q(std::cos(angle), std::sin(angle), 0.0);
    const CurveOffsets d = edgeCurve(p, q, smooth(p), smooth(q), {tangents, false});
    double largest = 0.0;
    for (int i = 1; i < 64; ++i)
      largest = std::max(
          largest, std::abs(glm::length(dvec3(curvePoint(p, q, d, static_cast<float>(i) / 64.0f))) - 1.0));
    return largest;
  };
  EXPECT_NEAR(error(1.0, Tangents::kProjected) / error(0.5, Tangents::kProjected), 16.0, 2.0);
  EXPECT_NEAR(error(1.6, Tangents::kCircular) / error(0.8, Tangents::kCircular), 64.0, 12.0);
  EXPECT_LT(error(0.5, Tangents::kCircular), 2e-5);
  EXPECT_NEAR(error(1.6, Tangents::kGeodesicArc), error(1.6, Tangents::kCircular), 1e-6);
  EXPECT_LT(error(0.5, Tangents::kGeodesic), 0.5 * error(0.5, Tangents::kProjected));
}

// The curve normal c'' - its tangent part is parallel to the surface normal at both ends.
TEST(EdgeCurve, GeodesicEnds) {
  Random random{std::mt19937(3)};
  for (int k = 0; k < 1000; ++k) {
    const vec3 p = random.vector(), q = random.vector(), ni = random.unit(), nj = random.unit();
    const CurveOffsets d = edgeCurve(p, q, smooth(ni), smooth(nj), {Tangents::kGeodesic, false});
    const vec3 ci = (2.0f * p + q) / 3.0f + d[0], cj = (p + 2.0f * q) / 3.0f + d[1];
    EXPECT_LT(std::fabs(dot(p - 2.0f * ci + cj, glm::cross(ci - p, ni))), 1e-5f) << k;
    EXPECT_LT(std::fabs(dot(q - 2.0f * cj + ci, glm::cross(cj - q, nj))), 1e-5f) << k;
  }
}

TEST(EdgeCurve, FeatureFallBacks) {
  const vec3 n(0, 0, 1), p(0, 0, 0), q(1, 0, -0.3f);
  const auto pair = [&](double degrees) {
    const double a = degrees * 3.141592653589793 / 180.0;
    return EdgeEnd{{n, vec3(0.0, std::sin(a), std::cos(a))}, true};
  };
  // Nearly parallel: as the smooth end. Opposed: straight. Otherwise (8).
  const CurveOffsets round = edgeCurve(p, q, smooth(n), smooth(n), {});
  EXPECT_LT(glm::length(edgeCurve(p, q, pair(0.2), pair(0.2), {})[0] - round[0]), 1e-3f);
  EXPECT_EQ(edgeCurve(p, q, pair(180.0), pair(180.0), {})[0], vec3(0.0f));
  const vec3 line(1, 0, 0);
  EXPECT_LT(glm::length(edgeCurve(p, q, pair(90.0), pair(90.0), {})[0] - (dot(q, line) * line - q) / 3.0f),
            1e-6f);
  // And continuous between them.
  for (int hundredths = 11; hundredths < 18000; ++hundredths) {
    const double degrees = 0.01 * hundredths;
    const vec3 step = edgeCurve(p, q, pair(degrees + 0.01), pair(90.0), {})[0] -
                      edgeCurve(p, q, pair(degrees), pair(90.0), {})[0];
    ASSERT_LT(glm::length(step), 5e-3f) << degrees;
  }
  // No tangent direction at all.
  for (const Tangents tangents : kAllTangents) {
    const CurveOffsets d = edgeCurve({0, 0, 0}, {0, 0, 1}, smooth(n), smooth(n), {tangents, false});
    EXPECT_TRUE(std::isfinite(d[0].z) && std::isfinite(d[1].z));
  }
}

TEST(Silhouetteness, IsAsWritten) {
  EXPECT_EQ(silhouettenessOf(-0.1f, 0.25f), 1.0f);
  EXPECT_EQ(silhouettenessOf(0.0f, 0.0f), 1.0f);
  EXPECT_EQ(silhouettenessOf(1e-9f, 0.0f), 0.0f);
  EXPECT_EQ(silhouettenessOf(0.125f, 0.25f), 0.5f);
  EXPECT_EQ(silhouettenessOf(0.3f, 0.25f), 0.0f);
  // β of (3) is sin φ sin(φ + θ), not below 0.
  for (int phi = 0; phi < 180; phi += 7) {
    for (int theta = 0; theta < 180; theta += 11) {
      const double a = phi * 3.141592653589793 / 180.0, b = theta * 3.141592653589793 / 180.0;
      const vec3 ns(0, 0, 1), nt(0.0, std::sin(b), std::cos(b));
      EXPECT_NEAR(wedgeBeta(ns, nt, static_cast<float>(std::sin(a)), static_cast<float>(std::cos(a))),
                  std::max(0.0, std::sin(a) * std::sin(a + b)), 1e-6);
    }
  }
}

// The crossing variant: whole where the contour crosses, and continuous where it leaves edges, faces and corners.
TEST(Silhouetteness, FollowsTheContour) {
  constexpr float kBeta = 0.1f;
  EXPECT_EQ(crossingSilhouetteness({-0.2f, 0.1f, {0.3f, 0.4f}}, kBeta), 1.0f);
  EXPECT_EQ(crossingSilhouetteness({0.0f, 0.1f, {0.3f, 0.4f}}, 0.0f), 1.0f);
  EXPECT_EQ(crossingSilhouetteness({0.2f, 0.2f, {0.5f, 0.4f}}, kBeta), 0.0f);
  // The contour crosses a face at a quarter of its height: c/(c + 0.6 m).
  EXPECT_FLOAT_EQ(crossingSilhouetteness({0.1f, 0.1f, {-0.3f, 0.4f}}, kBeta), 0.3f / 0.36f);
  EXPECT_FLOAT_EQ(crossingSilhouetteness({-0.1f, -0.1f, {-0.3f, 0.3f}}, kBeta), 0.3f / 0.36f);
  // Each facing moves through zero in small steps, the others wherever they are.
  Random random{std::mt19937(9)};
  for (int k = 0; k < 2000; ++k) {
    float g[4] = {random.next(), random.next(), random.next(), random.next()};
    const auto alpha = [&] {
      return crossingSilhouetteness({std::min(g[0], g[1]), std::max(g[0], g[1]), {g[2], g[3]}}, kBeta);
    };
    const std::size_t moving = random.engine() % 4;
    const float spread = std::max({g[0], g[1], g[2], g[3]}) - std::min({g[0], g[1], g[2], g[3]});
    if (spread < 0.1f || std::fabs(g[moving == 0 ? 1 : 0]) < 0.01f) continue;
    g[moving] = -1e-5f;
    const float before = alpha();
    g[moving] = 1e-5f;
    EXPECT_NEAR(alpha(), before, 2e-2f) << "case " << k;
  }
}

// A patch that is whole from the contour on has there, and beyond, the points of the whole patch.
TEST(Patch, IsWholeFromTheContour) {
  Random random{std::mt19937(10)};
  for (int k = 0; k < 100; ++k) {
    Patch whole;
    for (CurveOffsets& side : whole.sides) side = {random.vector(), random.vector()};
    Patch blended = whole;
    blended.wholeFromContour = true;
    blended.alphas[0] = 0.6f;  // the contour runs at w = 0.4
    for (const float w : {0.4f, 0.5f, 0.9f}) {
      const float v = 0.3f * (1.0f - w), u = 1.0f - v - w;
      EXPECT_LT(glm::length(blended.offset(u, v, w) - whole.offset(u, v, w)), 1e-6f);
    }
    const vec3 onSide = blended.offset(0.5f, 0.5f, 0.0f);  // and on the side the blended curve's
    EXPECT_LT(glm::length(onSide - 0.6f * curveOffset(whole.sides[0], 0.5f)), 1e-6f);
  }
}

TEST(Silhouetteness, OfACubesEdges) {
  const Shape box = cube();
  Workers workers(1);
  const Topology topology(box.mesh());
  Refiner refiner(box.mesh(), topology, workers);
  std::vector<float> alphas;
  Parameters parameters;
  parameters.silhouetteness = Silhouetteness::kEdge;
  refiner.silhouetteness(orthographicAlong({-1, -1, -1}), parameters, alphas);
  EXPECT_EQ(std::count(alphas.begin(), alphas.end(), 1.0f), 12);  // features are always smooth
  parameters.features = false;
  parameters.beta = 0.0f;
  refiner.silhouetteness(orthographicAlong({-1, -1, -1}), parameters, alphas);
  EXPECT_EQ(std::count(alphas.begin(), alphas.end(), 1.0f), 6);  // the hexagon
  EXPECT_EQ(std::count(alphas.begin(), alphas.end(), 0.0f), 12);
  // On a midpoint of an edge there is no direction to look along: α = 1.
  parameters.beta = 0.25f;
  const Edge& edge = topology.edges()[0];
  const EdgeVertices v = edgeVertices(box.mesh(), edge);
  refiner.silhouetteness(perspectiveFrom(0.5f * (box.positions[v[0][0]] + box.positions[v[0][1]])),
                         parameters, alphas);
  EXPECT_EQ(alphas[0], 1.0f);
}

}  // namespace
}  // namespace limn::silhouette::test
