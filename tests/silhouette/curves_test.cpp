// Silhouette curves as a method: what holds for every mesh and viewpoint.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "raster/base/elementary.h"
#include "shapes.h"
#include "silhouette/robust_ends.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

Parameters curves(float tolerance = 0.25f) {
  Parameters parameters;
  parameters.method = Method::kCurves;
  parameters.tolerance = tolerance;
  return parameters;
}

vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> normal;
  vec3 v(0.0f);
  while (glm::length(v) < 1e-3f) v = {normal(random), normal(random), normal(random)};
  return glm::normalize(v);
}

View randomView(std::mt19937& random, float radius) {
  std::uniform_real_distribution<float> uniform;
  const vec3 direction = randomDirection(random);
  if (uniform(random) < 0.3f) return orthographicAlong(direction);
  return perspectiveFrom(radius * (uniform(random) < 0.2f ? 1.02f : 1.2f + 5.0f * uniform(random)) *
                         direction);
}

TEST(Curves, WatertightFromRandomViewpoints) {
  std::mt19937 random(11);
  for (const Shape& shape : allShapes()) {
    const Topology topology(shape.mesh());
    Workers workers(1);
    Refiner refiner(shape.mesh(), topology, workers);
    RefinedStream stream;
    stream.clear(shape.mesh().triangleCount());
    const std::size_t open = openSides(drawnTriangles(shape.mesh(), stream));
    for (int k = 0; k < 20; ++k) {
      Parameters parameters = curves(k % 4 == 0 ? 0.02f : 0.25f);
      parameters.robust = k % 3 != 0;
      parameters.boundaries = k % 5 == 0;
      refiner.refine(randomView(random, 2.0f), parameters, stream);
      ASSERT_TRUE(stream.isConsistent(shape.mesh())) << shape.name << " view " << k;
      ASSERT_EQ(openSides(drawnTriangles(shape.mesh(), stream)),
                open + verticesOnBoundaries(topology, stream))
          << shape.name << " view " << k;
    }
  }
}

// Seen exactly along an edge's plane, vertices lie on the contour: g = 0.
TEST(Curves, WatertightWhereVerticesLieOnTheContour) {
  for (const Shape& shape : {icosphere(2), torus(24, 12), cylinder(12)}) {
    const Topology topology(shape.mesh());
    Workers workers(1);
    Refiner refiner(shape.mesh(), topology, workers);
    RefinedStream stream;
    for (const vec3& direction : {vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0.6f, 0.8f, 0)})
      for (const float tolerance : {0.0f, 0.25f, 1e9f}) {
        refiner.refine(orthographicAlong(direction), curves(tolerance), stream);
        ASSERT_TRUE(stream.isConsistent(shape.mesh())) << shape.name;
        EXPECT_EQ(openSides(drawnTriangles(shape.mesh(), stream)), 0u) << shape.name;
      }
  }
}

// No spikes: with or without robust ends, on meshes whose normals are noise too, a new vertex is within 0.9 of its
// triangle's longest side of the point of the flat triangle that its origin names. (A bridge leaves its edge by at
// most 0.3 of it, a segment between two such points its chord by 0.3 of at most 1.6 sides, and a polyline's vertices
// lie at most 0.09 outside it.)
// Exporters round the normals on both sides of a texture seam apart.
TEST(Curves, SeamsWithRoundedNormalsGetNoSlivers) {
  std::mt19937 random(3);
  Shape shape = torn(icosphere(2));
  const Shape exact = shape;
  for (vec3& n : shape.normals)
    for (int axis = 0; axis < 3; ++axis)
      n[axis] += 1e-6f * (static_cast<float>(random() % 2001) / 1000.0f - 1.0f);
  const auto trianglesOf = [](const Shape& drawn, const View& view) {
    const Mesh mesh = drawn.mesh();
    const Topology topology(mesh);
    Workers workers(1);
    RefinedStream stream;
    Refiner(mesh, topology, workers).refine(view, curves(), stream);
    return stream.triangleCount();
  };
  for (const View& view : someViews(4.0f)) EXPECT_EQ(trianglesOf(shape, view), trianglesOf(exact, view));
}

TEST(Curves, NewVerticesStayNearTheirTriangle) {
  std::mt19937 random(17);
  std::vector<Shape> shapes = allShapes();
  for (const std::uint32_t seed : {1u, 2u, 3u}) shapes.push_back(shaken(icosphere(2), seed));
  for (const Shape& shape : shapes) {
    const Topology topology(shape.mesh());
    Workers workers(1);
    Refiner refiner(shape.mesh(), topology, workers);
    RefinedStream stream;
    for (int k = 0; k < 20; ++k) {
      Parameters parameters = curves();
      parameters.robust = k % 2 == 0;
      parameters.boundaries = k % 3 == 0;
      refiner.refine(randomView(random, 2.0f), parameters, stream);
      for (std::size_t i = 0; i < stream.positions.size(); ++i) {
        const Origin& origin = stream.origins[i];
        std::array<vec3, 3> corner;
        for (std::size_t c = 0; c < 3; ++c)
          corner[c] = shape.positions[shape.indices[3 * std::size_t{origin.triangle} + c]];
        const float longest =
            std::max({glm::length(corner[1] - corner[0]), glm::length(corner[2] - corner[1]),
                      glm::length(corner[0] - corner[2])});
        const vec3 flat = corner[0] + origin.weights.x * (corner[1] - corner[0]) +
                          origin.weights.y * (corner[2] - corner[0]);
        ASSERT_LE(glm::length(stream.positions[i] - flat), 0.9f * longest) << shape.name << " view " << k;
      }
    }
  }
}

// Shading on new vertices is what it is on the flat triangle: linear between the corners, whatever the position.
// Every question in front or behind, concave or convex, would be answered the wrong way round.
TEST(Curves, NormalsThatPointInwardsLeaveTheMeshFlat) {
  for (Shape shape : {icosphere(2), torus(24, 12)}) {
    for (vec3& normal : shape.normals) normal = -normal;
    const Topology topology(shape.mesh());
    Workers workers(1);
    Refiner refiner(shape.mesh(), topology, workers);
    RefinedStream stream;
    for (const View& view : someViews(4.0f)) {
      refiner.refine(view, curves(), stream);
      EXPECT_TRUE(stream.indices.empty()) << shape.name;
    }
  }
}

TEST(Curves, NormalsAreLinear) {
  const Shape shape = shaken(torus(16, 8), 9);
  const Topology topology(shape.mesh());
  Workers workers(1);
  Refiner refiner(shape.mesh(), topology, workers);
  RefinedStream stream;
  refiner.refine(perspectiveFrom({1, 2, 4}), curves(), stream);
  ASSERT_GT(stream.positions.size(), 0u);
  for (std::size_t i = 0; i < stream.positions.size(); ++i) {
    const std::uint32_t* corner = &shape.indices[3 * std::size_t{stream.origins[i].triangle}];
    const glm::vec2 w = stream.origins[i].weights;
    const vec3 linear = (1.0f - w.x - w.y) * shape.normals[corner[0]] + w.x * shape.normals[corner[1]] +
                        w.y * shape.normals[corner[2]];
    EXPECT_LE(glm::length(stream.normals[i] - linear), 1e-6f);
  }
}

// The outline as a support function: how far the drawn surface reaches in directions across the view.
std::vector<float> reaches(const std::vector<vec3>& triangles, const vec3& right, const vec3& up) {
  std::vector<float> result;
  for (int angle = 0; angle < 360; angle += 3) {
    const SinCos a = sinCosDegrees(angle);
    const vec3 ray = static_cast<float>(a.cos) * right + static_cast<float>(a.sin) * up;
    float reach = -1e9f;
    for (const vec3& p : triangles) reach = std::max(reach, glm::dot(p, ray));
    result.push_back(reach);
  }
  return result;
}

// A turntable in steps of 0.05 degrees: the convex outline moves less than the tolerance more than the shape's own
// does, which for a solid of radius 1 turning is 0.00088 units.
TEST(Curves, OutlineDoesNotPop) {
  constexpr float kPixels = 300.0f, kTolerance = 0.25f, kTurn = 0.00088f * kPixels;
  for (const Shape& shape : {icosphere(2), torus(24, 12)}) {
    const Topology topology(shape.mesh());
    Workers workers(1);
    Refiner refiner(shape.mesh(), topology, workers);
    RefinedStream stream;
    std::vector<float> before;
    float largest = 0.0f;
    for (int frame = 0; frame < 300; ++frame) {
      const SinCos turn = sinCosDegrees(10.0 + 0.05 * frame);
      const vec3 direction =
          glm::normalize(vec3(static_cast<float>(turn.cos), 0.4f, static_cast<float>(turn.sin)));
      const vec3 right = glm::normalize(glm::cross(direction, vec3(0, 1, 0))),
                 up = glm::cross(right, direction);
      refiner.refine(orthographicAlong(direction), curves(kTolerance), stream);
      const std::vector<float> now = reaches(drawnTriangles(shape.mesh(), stream), right, up);
      for (std::size_t k = 0; k < before.size(); ++k)
        largest = std::max(largest, kPixels * std::abs(now[k] - before[k]));
      before = now;
    }
    EXPECT_LE(largest, kTolerance + (shape.name.starts_with("torus") ? 1.4f * kTurn : 0.0f)) << shape.name;
  }
}

// The farthest point from the middle as seen along z: on a sphere's outline it is the radius everywhere.
TEST(Curves, OutlineOfASphereIsRound) {
  const Shape shape = icosphere(2);
  const Topology topology(shape.mesh());
  Workers workers(1);
  Refiner refiner(shape.mesh(), topology, workers);
  RefinedStream stream;
  std::mt19937 random(3);
  for (int k = 0; k < 10; ++k) {
    const vec3 direction = randomDirection(random);
    refiner.refine(orthographicAlong(direction), curves(0.02f), stream);
    const std::vector<vec3> triangles = drawnTriangles(shape.mesh(), stream);
    const vec3 right = glm::normalize(glm::cross(direction, vec3(0.3f, 0.5f, 0.8f)));
    const vec3 up = glm::cross(right, direction);
    for (int angle = 0; angle < 360; ++angle) {
      const float a = static_cast<float>(angle) * 0.0174533f;
      const vec3 ray = std::cos(a) * right + std::sin(a) * up;
      float reach = 0.0f;
      for (const vec3& p : triangles) reach = std::max(reach, glm::dot(p, ray));
      EXPECT_NEAR(reach, 1.0f, 2.5e-4f);  // 0.075 pixels; the flat mesh is 0.01 off
    }
  }
}

TEST(Curves, SameForAnyNumberOfThreads) {
  for (const Shape& shape : {icosphere(5), shaken(torus(60, 40), 3)}) {
    const Topology topology(shape.mesh());
    const View view = perspectiveFrom({1, 2, 4});
    RefinedStream one;
    for (const int threads : {1, 2, 3, 8}) {
      Workers workers(threads);
      Refiner refiner(shape.mesh(), topology, workers);
      RefinedStream stream;
      refiner.refine(view, curves(0.01f), stream);
      if (threads == 1) one = stream;
      EXPECT_GT(stream.triangleCount(), 0u);
      EXPECT_EQ(stream.positions, one.positions) << threads;
      EXPECT_EQ(stream.normals, one.normals) << threads;
      EXPECT_EQ(stream.indices, one.indices) << threads;
      EXPECT_EQ(stream.sourceTriangles, one.sourceTriangles) << threads;
    }
  }
}

// A deformed mesh is refined as a new one would be.
TEST(Curves, DeformedMeshIsAsANewOne) {
  const Shape rest = torus(16, 8), moved = shaken(rest, 5);
  const Topology topology(rest.mesh());
  Workers workers(1);
  Refiner refiner(rest.mesh(), topology, workers), fresh(moved.mesh(), topology, workers);
  const View view = perspectiveFrom({1, 2, 4});
  RefinedStream a, b;
  refiner.refine(view, curves(), a);
  refiner.deform(moved.mesh());
  refiner.refine(view, curves(), a);
  fresh.refine(view, curves(), b);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.indices, b.indices);
}

// Normals of a polygon that was simplified are neither the means of the faces that are left nor those of a finer shape.
TEST(RobustEnds, TrustsOwnNormalsAndThoseOfFinerShapes) {
  for (const float trusted : {0.0f, 0.15f, 0.9f, 2.0f, 1e9f}) EXPECT_EQ(RobustEnds::trustOf(trusted), 1.0f);
  for (const float doubted : {0.4f, 0.5f, 0.6f}) EXPECT_EQ(RobustEnds::trustOf(doubted), 0.0f);
  for (const float between : {0.25f, 0.75f}) {
    EXPECT_GT(RobustEnds::trustOf(between), 0.0f);
    EXPECT_LT(RobustEnds::trustOf(between), 1.0f);
  }
}

}  // namespace
}  // namespace limn::silhouette::test
