// Fitted curves: their frames, and that a patch drawn with them keeps what patches promise.
#include "silhouette/fitted_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <random>

#include "silhouette/edge_curves.h"
#include "silhouette/patch.h"
#include "tests/silhouette/shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::vec2;
using glm::vec3;

constexpr std::uint32_t kSeed = 20241;

float uniform(std::mt19937& random) {
  return static_cast<float>(random()) / 4294967296.0f * 2.0f - 1.0f;
}
vec3 vector(std::mt19937& random) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

// Rotation by the angle whose cosine is 0.6 about z, then exchange of the axes: rational and exact enough.
vec3 turned(const vec3& v) {
  return {v.z, 0.6f * v.x - 0.8f * v.y, 0.8f * v.x + 0.6f * v.y};
}

/// Small random curves for every edge and triangle of a shape.
struct RandomCurves {
  std::vector<FittedEnds> edges;
  std::vector<vec3> centers;

  RandomCurves(const Topology& topology, std::size_t triangles, std::uint32_t seed) {
    std::mt19937 random(seed);
    for (std::size_t e = 0; e < topology.edges().size(); ++e) {
      const vec3 first = vector(random), second = vector(random);
      edges.push_back({0.1f * first, 0.1f * second});
    }
    for (std::size_t t = 0; t < triangles; ++t) centers.push_back(0.1f * vector(random));
  }
  FittedCurves curves() const { return {edges, centers}; }
};

TEST(FittedCurves, EndsGiveTheOffsetsBack) {
  std::mt19937 random(kSeed);
  for (int k = 0; k < 2000; ++k) {
    const vec3 pi = vector(random), pj = vector(random);
    const vec3 ni = glm::normalize(vector(random)), nj = glm::normalize(vector(random));
    const float length = glm::distance(pi, pj);
    const std::array<vec3, 2> offsets = {length * vector(random), length * vector(random)};
    const vec3 along = (pj - pi) / length;
    if (glm::length(glm::cross(ni + nj, along)) < 0.1f) continue;  // no frame, a straight end
    const std::array<vec3, 2> back = fittedOffsets(pi, pj, ni, nj, fittedEnds(pi, pj, ni, nj, offsets));
    for (int end = 0; end < 2; ++end)
      EXPECT_LT(glm::distance(back[end], offsets[end]), 2e-6f * length) << "seed " << kSeed << " case " << k;
  }
}

TEST(FittedCurves, EitherEndSeesTheSameCurve) {
  std::mt19937 random(kSeed);
  for (int k = 0; k < 500; ++k) {
    const vec3 pi = vector(random), pj = vector(random);
    const vec3 ni = glm::normalize(vector(random)), nj = glm::normalize(vector(random));
    const FittedEnds ends = {vector(random), vector(random)};
    const std::array<vec3, 2> here = fittedOffsets(pi, pj, ni, nj, ends);
    const std::array<vec3, 2> there = fittedOffsets(pj, pi, nj, ni, {ends[1], ends[0]});
    for (int end = 0; end < 2; ++end)
      EXPECT_LT(glm::distance(here[end], there[1 - end]), 1e-5f) << "seed " << kSeed << " case " << k;
  }
}

TEST(FittedCurves, MoveWithTheMesh) {
  std::mt19937 random(kSeed);
  for (int k = 0; k < 500; ++k) {
    const vec3 pi = vector(random), pj = vector(random), shift = vector(random);
    const vec3 ni = glm::normalize(vector(random)), nj = glm::normalize(vector(random));
    if (glm::length(glm::cross(ni + nj, glm::normalize(pj - pi))) < 0.1f) continue;
    const FittedEnds ends = {vector(random), vector(random)};
    const std::array<vec3, 2> rest = fittedOffsets(pi, pj, ni, nj, ends);
    const std::array<vec3, 2> moved =
        fittedOffsets(turned(pi) + shift, turned(pj) + shift, turned(ni), turned(nj), ends);
    for (int end = 0; end < 2; ++end)
      EXPECT_LT(glm::distance(moved[end], turned(rest[end])), 2e-5f) << "seed " << kSeed << " case " << k;
  }
}

TEST(FittedCurves, NothingStoredIsTheProjectedHeight) {
  // Symmetric normals on a chord of length 1: (7) lifts its end by sin θ cos θ / 3 across the chord, (F1) by
  // sin θ / 3.
  const float sine = 0.1f, cosine = std::sqrt(1.0f - sine * sine);
  const std::array<vec3, 2> offsets = fittedOffsets({0, 0, 0}, {1, 0, 0}, {-sine, 0, cosine},
                                                    {sine, 0, cosine}, FittedEnds{vec3(0), vec3(0)});
  EXPECT_NEAR(offsets[0].z, sine / 3.0f, 1e-6f);
  EXPECT_NEAR(offsets[1].z, sine / 3.0f, 1e-6f);
  EXPECT_NEAR(offsets[0].x, 0.0f, 1e-6f);
}

TEST(FittedCurves, NormalsAlongTheEdgeMakeItStraight) {
  const std::array<vec3, 2> offsets =
      fittedOffsets({0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, FittedEnds{vec3(0.5f), vec3(0.5f)});
  EXPECT_EQ(offsets[0], vec3(0.0f));
  EXPECT_EQ(offsets[1], vec3(0.0f));
}

TEST(FittedCurves, CenterGivesTheOffsetBack) {
  std::mt19937 random(kSeed);
  for (int k = 0; k < 500; ++k) {
    const vec3 a = vector(random), b = vector(random), c = vector(random), offset = 0.3f * vector(random);
    if (glm::length(glm::cross(b - a, c - a)) < 0.05f) continue;
    EXPECT_LT(glm::distance(fittedCenter(a, b, c, fittedCenterOf(a, b, c, offset)), offset), 1e-4f)
        << "seed " << kSeed << " case " << k;
  }
  EXPECT_EQ(fittedCenter({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, vec3(1.0f)), vec3(0.0f));
}

TEST(FittedCurves, EveryEdgeIsMetOnce) {
  for (const Shape& shape : allShapes()) {
    const Topology topology(shape.mesh());
    std::vector<bool> runsBack;
    std::vector<std::uint32_t> order = edgesAsFirstMet(shape.mesh(), topology, &runsBack);
    ASSERT_EQ(order.size(), topology.edges().size()) << shape.name;
    ASSERT_EQ(runsBack.size(), order.size()) << shape.name;
    std::sort(order.begin(), order.end());
    for (std::size_t e = 0; e < order.size(); ++e) EXPECT_EQ(order[e], e) << shape.name;
  }
}

class FittedMethods : public testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Both, FittedMethods, testing::Values(Method::kPatches, Method::kCurves),
                         [](const auto& tested) {
                           return tested.param == Method::kPatches ? "Patches" : "Curves";
                         });

TEST_P(FittedMethods, StayClosedWithAnyCurves) {
  for (const Shape& shape : allShapes()) {
    const Mesh mesh = shape.mesh();
    const Topology topology(mesh);
    const RandomCurves random(topology, mesh.triangleCount(), kSeed);
    Workers one(1), four(4);
    Refiner single(mesh, topology, one, random.curves()), many(mesh, topology, four, random.curves());
    const std::size_t open = openSides(drawnTriangles(mesh, [&] {
      RefinedStream none;
      none.clear(mesh.triangleCount());
      return none;
    }()));
    for (const View& view : someViews(4.0f)) {
      RefinedStream stream, other;
      Parameters parameters;
      parameters.method = GetParam();
      parameters.tolerance = 0.2f;
      single.refine(view, parameters, stream);
      many.refine(view, parameters, other);
      EXPECT_TRUE(stream.isConsistent(mesh)) << shape.name;
      EXPECT_EQ(stream.positions, other.positions) << shape.name;
      EXPECT_EQ(stream.indices, other.indices) << shape.name;
      if (open == 0) {
        EXPECT_EQ(openSides(drawnTriangles(mesh, stream)), 0u) << shape.name;
      }
    }
  }
}

// The patch above a straight line of weights is a cubic, and that is the silhouette segment.
TEST(FittedCurves, SilhouetteSegmentsRunOnThePatches) {
  constexpr int kSegments = 32;
  std::size_t inside = 0;
  for (const Shape& shape : {icosphere(1), torus(12, 8), shaken(icosphere(1), 3)}) {
    const Mesh mesh = shape.mesh();
    const Topology topology(mesh);
    const RandomCurves random(topology, mesh.triangleCount(), kSeed);
    std::vector<CurveOffsets> curves;
    std::vector<vec3> centers;
    placeFittedCurves(mesh, topology, random.curves(), Crew(0), curves, centers);
    const auto patchOf = [&](std::uint32_t t) {
      Patch patch;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = mesh.indices[3 * t + k], e = topology.sideEdges()[3 * t + k];
        patch.corners[k] = mesh.positions[from];
        patch.sides[k] = curves[e];
        if (topology.points()[from] != topology.edges()[e].point[0])
          std::swap(patch.sides[k][0], patch.sides[k][1]);
      }
      patch.fittedCenter = centers[t];
      return patch;
    };
    Workers one(1);
    Refiner refiner(mesh, topology, one, random.curves());
    Parameters parameters;
    parameters.method = Method::kCurves;
    parameters.segments = kSegments;
    parameters.listContour = true;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const View& view : someViews(4.0f)) {
      RefinedStream stream;
      refiner.refine(view, parameters, stream);
      for (const ContourLine& line : stream.contour) {
        if (!line.crossesTriangle || line.from < first) continue;
        const Origin& origin = stream.origins[line.from - first];
        const vec2 w = origin.weights;
        const vec3 place = patchOf(origin.triangle).point(1.0f - w.x - w.y, w.x, w.y);
        const vec3 &a = mesh.positions[mesh.indices[3 * origin.triangle]],
                   &b = mesh.positions[mesh.indices[3 * origin.triangle + 1]];
        // Vertices are 3/4 of a sagitta outside the curve, and its second derivative is at most about six sides.
        ASSERT_LT(glm::distance(stream.positions[line.from - first], place),
                  0.75f / 8.0f * 6.0f / (kSegments * kSegments) * glm::distance(a, b) + 1e-5f)
            << shape.name;
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 1000u);
}

TEST(FittedCurves, RefinerWantsOnePerEdgeAndTriangle) {
  const Shape shape = icosphere(1);
  const Topology topology(shape.mesh());
  RandomCurves random(topology, shape.mesh().triangleCount(), kSeed);
  random.edges.pop_back();
  Workers workers(1);
  EXPECT_THROW(Refiner(shape.mesh(), topology, workers, random.curves()), std::invalid_argument);
}

}  // namespace
}  // namespace limn::silhouette::test
