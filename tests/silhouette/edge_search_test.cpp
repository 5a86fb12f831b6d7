// What the search for silhouette curves passes over does not matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "shapes.h"
#include "silhouette/edge_search.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

TEST(NormalCone, BoundsTheFacingsOfWhatItHolds) {
  std::mt19937 random(6);
  const auto next = [&] { return static_cast<float>(random() % 2000001) / 1000000.0f - 1.0f; };
  const auto vector = [&] { return vec3(next(), next(), next()); };
  std::size_t known = 0;
  for (int round = 0; round < 2000; ++round) {
    const float size = round % 2 == 0 ? 0.5f : 0.02f, width = round % 3 == 0 ? 0.7f : 0.1f;
    const vec3 middle = vector(), along = vector();
    std::vector<vec3> points, normals;
    vec3 low(10.0f), high(-10.0f), sum(0.0f);
    for (int i = 0; i < 12; ++i) {
      points.push_back(middle + size * vector());
      normals.push_back(glm::normalize(glm::normalize(along) + width * vector()));
      low = glm::min(low, points.back());
      high = glm::max(high, points.back());
      sum += normals.back();
    }
    NormalCone cone;
    cone.begin(low, high, sum);
    for (const vec3& n : normals) cone.include(n);
    cone.finish();
    for (const View& view : someViews(2.0f)) {
      const FacingBound bound = cone.facings(view);
      if (!(bound.least > 0.0f)) continue;
      ++known;
      float least = 2.0f, most = -2.0f;
      for (const vec3& p : points)
        for (const vec3& n : normals) {
          const float facing = glm::dot(n, glm::normalize(towardsEye(view, p)));
          least = std::min(least, facing);
          most = std::max(most, facing);
        }
      ASSERT_GT(least * most, 0.0f);
      ASSERT_GE(std::min(std::fabs(least), std::fabs(most)), bound.least);
      ASSERT_LE(most - least, bound.spread);
    }
  }
  EXPECT_GT(known, 1000u);
}

// Every edge that a silhouette curve crosses is listed with the place where, and every other one that is passed over faces
// clearly one way or has a curve that nobody sees.
TEST(EdgeSearch, PassesOverOnlyWhatDoesNotMatter) {
  std::size_t crossed = 0, passedOver = 0;
  std::vector<Shape> shapes = allShapes();
  shapes.push_back(icosphere(5));
  for (const Shape& shape : shapes) {
    const Mesh mesh = shape.mesh();
    const Topology topology(mesh);
    const Crew crew(0);
    CurveSet curves;
    EdgeSearch search;
    for (const float tolerance : {0.5f, 0.02f}) {
      Parameters parameters;
      parameters.tolerance = tolerance;
      curves.prepare(mesh, topology, {}, parameters, crew);
      for (const View& view : someViews(4.0f)) {
        search.run(mesh, topology, curves, view, parameters, crew);
        const PixelBound bound(view);
        const RingTest ring{mesh,           topology,       curves,        view,
                            search.visible, search.heights, search.points, search.pointsOf};
        std::size_t next = 0;
        for (std::uint32_t e = 0; e < topology.edges().size(); ++e) {
          const bool isCandidate = next < search.candidates.size() && search.candidates[next] == e;
          next += isCandidate ? 1 : 0;
          const EdgeLink& link = curves.links[e];
          for (std::size_t face = 0; face < 2; ++face) {
            const std::array<std::uint32_t, 2>& v = curves.vertices[e][face];
            const std::array<vec3, 2> p{mesh.positions[v[0]], mesh.positions[v[1]]},
                n{mesh.normals[v[0]], mesh.normals[v[1]]};
            if ((facing(view, p[0], n[0]) >= 0.0f) == (facing(view, p[1], n[1]) >= 0.0f)) continue;
            if (!link.bridged) continue;
            ASSERT_TRUE(isCandidate && search.isCrossed(e)) << shape.name << ", edge " << e;
            const SilhouettePoint& point = search.points[search.pointsOf[e]][face];
            ASSERT_TRUE(point.exists);
            ASSERT_EQ(point.parameter, contourParameter(view, p, n, normalTurn(p, n, curves.curves[e])));
            ASSERT_EQ(point.end.place, curvePoint(p[0], p[1], curves.curves[e], point.parameter));
            ++crossed;
          }
          if (isCandidate) continue;
          ++passedOver;
          ASSERT_FALSE(link.always) << shape.name << ", edge " << e;
          if (link.bend == 0.0f || ring.silhouetteness(e) == 0.0f) continue;
          const vec3 &p = mesh.positions[link.ends[0]], &q = mesh.positions[link.ends[1]];
          ASSERT_LE(bound.curveError(p, q, curves.curves[e]).bend, 0.25f * tolerance)
              << shape.name << ", edge " << e;
        }
        ASSERT_EQ(next, search.candidates.size()) << "not ascending, " << shape.name;
      }
    }
  }
  EXPECT_GT(crossed, 1000u);
  EXPECT_GT(passedOver, 1000u);
}

bool isBelievedAround(const CurveSet& curves, const Topology& topology, std::uint32_t e) {
  for (const Side& face : topology.edges()[e].faces)
    for (std::size_t k = 0; k < 3 && face.triangle != kNone; ++k)
      if (!curves.trust[topology.sideEdges()[3 * std::size_t{face.triangle} + k]].isNone()) return true;
  return false;
}

// Where the contour passes over a vertex, it leaves one of the edges around it for another: all of them have their silhouette
// points there then, unless nothing is believed beside them, and believe them to the same degree, however much their own
// normals are doubted.
TEST(EdgeSearch, EdgesAgreeAtAVertexThatTheContourPassesOver) {
  constexpr float kTilt = 1e-7f;
  std::size_t compared = 0, doubted = 0;
  for (const Shape& shape : {shaken(icosphere(3), 5), shaken(torus(24, 12), 6), bumpyGrid(12)}) {
    const Mesh mesh = shape.mesh();
    const Topology topology(mesh);
    const Crew crew(0);
    const Parameters parameters;
    CurveSet curves;
    curves.prepare(mesh, topology, {}, parameters, crew);
    EdgeSearch search;
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
      const vec3& n = mesh.normals[vertex];
      const vec3 along = glm::normalize(glm::cross(n, vec3(0.3f, 0.5f, 0.8f)));
      std::vector<float> trusts;
      std::size_t passed = 0;
      for (const float tilt : {-kTilt, kTilt}) {
        const View view = orthographicAlong(along + tilt * n);
        search.run(mesh, topology, curves, view, parameters, crew);
        for (std::uint32_t e = 0; e < topology.edges().size(); ++e) {
          const std::array<std::uint32_t, 2>& v = curves.vertices[e][0];
          if ((v[0] != vertex && v[1] != vertex) || search.visible[v[0]] == search.visible[v[1]]) continue;
          const std::size_t end = v[0] == vertex ? 0 : 1;
          if (!search.isCrossed(e)) {
            EXPECT_FALSE(isBelievedAround(curves, topology, e)) << shape.name << ", edge " << e;
            continue;
          }
          const SilhouettePoint& point = search.points[search.pointsOf[e]][0];
          if (std::fabs(facing(view, mesh.positions[v[1 - end]], mesh.normals[v[1 - end]])) < 0.05f) continue;
          ASSERT_NEAR(point.parameter, static_cast<float>(end), 0.01f) << shape.name << ", edge " << e;
          trusts.push_back(point.end.trust);
          ++passed;
        }
      }
      if (trusts.empty()) continue;
      const auto [least, most] = std::minmax_element(trusts.begin(), trusts.end());
      EXPECT_LE(*most - *least, 0.02f) << shape.name << ", vertex " << vertex;
      compared += passed;
      doubted += *most < 1.0f ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 1000u);
  EXPECT_GT(doubted, 100u);
}

}  // namespace
}  // namespace limn::silhouette::test
