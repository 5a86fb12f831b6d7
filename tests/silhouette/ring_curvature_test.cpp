#include "silhouette/ring_curvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "shapes.h"
#include "silhouette/robust_ends.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

struct Rings {
  explicit Rings(const Shape& shape) : mesh(shape.mesh()), topology(mesh), ups(topology.pointCount()) {
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) ups[topology.points()[v]] = 3.0f * mesh.normals[v];
    curvature.prepare(mesh, topology, ups, std::vector<std::uint8_t>(topology.pointCount(), 1), Crew(0));
  }
  vec3 along(const Edge& edge) const {
    const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, edge)[0];
    return mesh.positions[ends[1]] - mesh.positions[ends[0]];
  }
  float turn(const Edge& edge, std::size_t end) const { return curvature.turn(edge.point[end], along(edge)); }

  Mesh mesh;
  Topology topology;
  std::vector<vec3> ups;
  RingCurvature curvature;
};

TEST(RingCurvature, OfTheUnitSphereIsOne) {
  const Shape sphere = icosphere(3);
  const Rings rings(sphere);
  for (const Edge& edge : rings.topology.edges())
    EXPECT_NEAR(rings.turn(edge, 0) / glm::length(rings.along(edge)), 1.0f, 0.05f);
}

// Meusnier and Euler: 1/0.4 around the tube, cos φ / (1 + 0.4 cos φ) along it, between them by squared cosines.
TEST(RingCurvature, OfATorusDependsOnTheDirection) {
  const Shape shape = torus(60, 30);
  const Rings rings(shape);
  for (const Edge& edge : rings.topology.edges()) {
    const vec3 p = rings.mesh.positions[edgeVertices(rings.mesh, edge)[0][0]], e = rings.along(edge);
    const float radius = std::hypot(p.x, p.y), cosine = (radius - 1.0f) / 0.4f;
    const float c = glm::dot(glm::normalize(e), vec3(-p.y, p.x, 0.0f) / radius);
    const float expected = c * c * cosine / radius + (1.0f - c * c) / 0.4f;
    EXPECT_NEAR(rings.turn(edge, 0) / glm::length(e), std::abs(expected), 0.2f);
  }
}

TEST(RingCurvature, DoesNotDependOnTheScaleOrOnSeams) {
  const Shape one = shaken(icosphere(2), 5);
  const Rings rings(one);
  for (const float scale : {std::ldexp(1.0f, -60), std::ldexp(1.0f, 60)}) {
    Shape other = one;
    for (vec3& p : other.positions) p *= scale;
    const Rings scaled(other);
    for (std::size_t e = 0; e < rings.topology.edges().size(); ++e)
      EXPECT_EQ(rings.turn(rings.topology.edges()[e], 1), scaled.turn(scaled.topology.edges()[e], 1));
  }
  Shape ripped = torn(one);
  const Rings seams(ripped);
  ASSERT_EQ(seams.topology.edges().size(), rings.topology.edges().size());
  double sum = 0.0, seamSum = 0.0;
  for (std::size_t e = 0; e < rings.topology.edges().size(); ++e) {
    sum += rings.turn(rings.topology.edges()[e], 0) + rings.turn(rings.topology.edges()[e], 1);
    seamSum += seams.turn(seams.topology.edges()[e], 0) + seams.turn(seams.topology.edges()[e], 1);
  }
  EXPECT_NEAR(sum, seamSum, 1e-4 * sum);
}

// A square tube, edges rounded by a radius of 0.1 with two vertices at each: the normals of both turn by 45 degrees between
// them, and by 45 along the flat sides as if those were arcs.
Shape roundedTube() {
  constexpr std::uint32_t kAround = 8, kRings = 5;
  Shape tube;
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const float corner = (static_cast<float>(k / 2) + 0.5f) * 1.5707963f;
      const float angle = corner + (k % 2 == 0 ? -0.3926991f : 0.3926991f);
      const vec3 normal(std::cos(angle), std::sin(angle), 0.0f);
      const vec3 centre = 1.2f * vec3(std::cos(corner), std::sin(corner), 0.0f);
      tube.positions.push_back(centre + 0.1f * normal + vec3(0.0f, 0.0f, static_cast<float>(ring)));
      tube.normals.push_back(normal);
    }
  for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t a = ring * kAround + k, b = ring * kAround + (k + 1) % kAround;
      tube.indices.insert(tube.indices.end(), {a, b, b + kAround, a, b + kAround, a + kAround});
    }
  return tube;
}

TEST(RobustEnds, FlatSidesBetweenRoundedCornersStayFlat) {
  const Shape tube = roundedTube();
  const Mesh mesh = tube.mesh();
  const Topology topology(mesh);
  RobustEnds ends;
  ends.prepare(mesh, topology, Crew(0));
  std::size_t flat = 0;
  for (const Edge& edge : topology.edges()) {
    const std::array<std::uint32_t, 2> v = edgeVertices(mesh, edge)[0];
    const vec3 &p = mesh.positions[v[0]], &q = mesh.positions[v[1]];
    if (p.z != 2.0f || q.z != 2.0f) continue;
    const std::array<float, 2> factors = ends.factors(edge);
    if (glm::distance(p, q) > 1.0f) {
      ++flat;
      EXPECT_LT(factors[0], 0.05f);
      EXPECT_LT(factors[1], 0.05f);
    } else {
      EXPECT_GT(factors[0], 0.5f);
      EXPECT_GT(factors[1], 0.5f);
    }
  }
  EXPECT_EQ(flat, 4u);
}

}  // namespace
}  // namespace limn::silhouette::test
