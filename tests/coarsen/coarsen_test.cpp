// From fine to coarse: the patches are compared with the analytic surface.
#include "apps/coarsen/coarsen.h"

#include <gtest/gtest.h>

#include "apps/coarsen/surface.h"
#include "raster/cluster.h"
#include "silhouette/patch.h"
#include "silhouette/refine.h"
#include "tests/coarsen/fine_models.h"

namespace limn::coarsen::test {
namespace {

using glm::vec3;

scene::Mesh coarseOf(const scene::Mesh& fine, std::size_t triangles, int threads = 2,
                     Report* report = nullptr) {
  Workers workers(threads);
  return coarsenMesh(fine, {triangles}, workers, report);
}

/// Points of all patches as they are drawn with α = 1, on a grid of their parameters.
std::vector<vec3> patchPoints(const scene::Mesh& mesh) {
  const silhouette::Mesh shape = shapeOf(mesh);
  const silhouette::Topology topology(shape);
  const scene::DecodedCurves curves = decode(mesh.curves, shape, topology);
  std::vector<vec3> points;
  for (std::size_t t = 0; t < shape.triangleCount(); ++t) {
    silhouette::Patch patch;
    for (std::size_t k = 0; k < 3; ++k) {
      patch.corners[k] = mesh.positions[mesh.indices[3 * t + k]];
      const std::uint32_t e = topology.sideEdges()[3 * t + k];
      const silhouette::Edge& edge = topology.edges()[e];
      const std::array<std::uint32_t, 2> ends = silhouette::edgeVertices(shape, edge)[0];
      const std::array<vec3, 2> normals = silhouette::endNormals(shape, edge);
      const silhouette::CurveOffsets offsets = silhouette::fittedOffsets(
          mesh.positions[ends[0]], mesh.positions[ends[1]], normals[0], normals[1], curves.edges[e]);
      const bool ascends = topology.points()[mesh.indices[3 * t + k]] == edge.point[0];
      patch.sides[k] = {offsets[ascends ? 0 : 1], offsets[ascends ? 1 : 0]};
    }
    patch.fittedCenter =
        silhouette::fittedCenter(patch.corners[0], patch.corners[1], patch.corners[2], curves.centers[t]);
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= i; ++j) {
        const float u = 1.0f - static_cast<float>(i) / 8.0f, w = static_cast<float>(j) / 8.0f;
        points.push_back(patch.point(u, 1.0f - u - w, w));
      }
  }
  return points;
}

/// Largest distance of the corners' triangles, and of the patches, from a surface whose distance function is given.
struct Distances {
  double flat = 0.0, patches = 0.0;
};
template <class Distance>
Distances distances(const scene::Mesh& mesh, const Distance& distance) {
  Distances result;
  for (const vec3& point : patchPoints(mesh))
    result.patches = std::max(result.patches, distance(glm::dvec3(point)));
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    glm::dvec3 middle(0.0);
    for (std::size_t k = 0; k < 3; ++k) middle += glm::dvec3(mesh.positions[mesh.indices[t + k]]) / 3.0;
    result.flat = std::max(result.flat, distance(middle));
  }
  return result;
}

TEST(Coarsen, SphereIsFittedFourthOrder) {
  const scene::Mesh fine = builtinMesh("icosphere:5");
  const double radius = glm::length(glm::dvec3(fine.positions[0]));
  const auto distance = [&](const glm::dvec3& p) { return std::abs(glm::length(p) - radius) / radius; };
  const Distances at200 = distances(coarseOf(fine, 200), distance),
                  at800 = distances(coarseOf(fine, 800), distance);
  EXPECT_LT(at200.patches, 0.003);  // flat: 0.03
  EXPECT_LT(at200.patches, 0.12 * at200.flat);
  EXPECT_LT(at800.patches, 0.0008);  // the fine sphere's own facets: 0.0007
}

TEST(Coarsen, TorusIsFitted) {
  const scene::Mesh fine = builtinMesh("torus:120:60");
  // Radii from the mesh itself: the farthest point from the axis, and half the height.
  glm::dvec3 low(1e9), high(-1e9);
  for (const vec3& p : fine.positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  const glm::dvec3 size = high - low;
  const int axis = size.x < size.y && size.x < size.z ? 0 : size.y < size.z ? 1 : 2;
  const double tube = 0.5 * size[axis], ring = 0.5 * size[(axis + 1) % 3] - tube;
  const auto distance = [&](const glm::dvec3& p) {
    const double a = p[(axis + 1) % 3], b = p[(axis + 2) % 3];
    return std::abs(std::hypot(std::hypot(a, b) - ring, p[axis]) - tube);
  };
  const Distances found = distances(coarseOf(fine, 500), distance);
  EXPECT_LT(found.patches, 0.02 * tube);
  EXPECT_LT(found.patches, 0.25 * found.flat);
}

TEST(Coarsen, KnotStaysClosedAndNear) {
  const scene::Mesh fine = builtinMesh("knot:160:24");
  Report report;
  const scene::Mesh coarse = coarseOf(fine, 500, 2, &report);
  EXPECT_EQ(eulerCharacteristic(coarse), 0);
  EXPECT_EQ(silhouette::Topology(shapeOf(coarse)).report().boundaryEdges, 0u);
  const Surface surface = makeSurface(fine.positions, fine.normals, fine.indices);
  const ClosestPoint closest(surface.points, surface.corners);
  double farthest = 0.0;
  for (const vec3& point : patchPoints(coarse))
    farthest = std::max(farthest, std::sqrt(closest.find(glm::dvec3(point))->distance2));
  EXPECT_LE(farthest, report.guard.limit * 1.02);  // the rest is rounding to bytes
}

TEST(Coarsen, NeighboursFollowEachOther) {
  const scene::Mesh coarse = coarseOf(builtinMesh("icosphere:4"), 500);
  raster::ClusterSet set;
  raster::VertexNumbers numbers;
  numbers.reserve(coarse.positions.size());
  raster::ClusterCutter cutter(set, coarse.indices.size() / 3, numbers);
  cutter.add(coarse.indices, 0);
  cutter.finish();
  // Of the 64 vertices of a round cluster about 28 lie on its border, and another cluster has them too.
  EXPECT_LT(static_cast<double>(set.vertices.size()), 1.35 * static_cast<double>(coarse.positions.size()));
}

TEST(Coarsen, SameBytesForAnyNumberOfThreads) {
  const scene::Mesh fine = builtinMesh("knot:100:16");
  const scene::Mesh one = coarseOf(fine, 300, 1), four = coarseOf(fine, 300, 4);
  EXPECT_EQ(one.positions, four.positions);
  EXPECT_EQ(one.indices, four.indices);
  EXPECT_EQ(one.curves.ends, four.curves.ends);
  EXPECT_EQ(one.curves.centers, four.curves.centers);
  EXPECT_EQ(one.curves.endScale, four.curves.endScale);
}

TEST(Coarsen, BoundaryFollowsTheFineOne) {
  const scene::Mesh coarse = coarseOf(bumpyField(40), 150);
  EXPECT_EQ(coarse.parts.size(), 2u);
  EXPECT_EQ(coarse.parts[0].triangleCount + coarse.parts[1].triangleCount, coarse.indices.size() / 3);
  EXPECT_EQ(coarse.texcoords.size(), coarse.positions.size());
  for (const vec3& point : patchPoints(coarse)) {
    EXPECT_LT(std::max(std::abs(point.x), std::abs(point.y)), 1.02f);
    EXPECT_NEAR(point.z, 0.25f * (point.x * point.x * point.x - 2.0f * point.x * point.y * point.y), 0.02f);
  }
}

TEST(Coarsen, MeshOfTheUserStaysAsItIs) {
  const scene::Mesh fine = builtinMesh("icosphere:5"), brought = builtinMesh("icosphere:1");
  scene::Mesh coarse = brought;
  Workers workers(2);
  fitMesh(fine, coarse, workers);
  EXPECT_EQ(coarse.positions, brought.positions);
  EXPECT_EQ(coarse.indices, brought.indices);
  const double radius = glm::length(glm::dvec3(fine.positions[0]));
  const Distances found =
      distances(coarse, [&](const glm::dvec3& p) { return std::abs(glm::length(p) - radius) / radius; });
  EXPECT_LT(found.patches, 0.1 * found.flat);
}

TEST(Coarsen, BonesAndMorphsComeAlong) {
  scene::Mesh fine = builtinMesh("icosphere:3");
  scene::SkinBinding binding;
  scene::MorphTarget target;
  for (const vec3& p : fine.positions) {
    binding.joints.push_back({static_cast<std::uint16_t>(p.x > 0 ? 1 : 0), 0, 0, 0});
    binding.weights.push_back({1, 0, 0, 0});
    target.positions.push_back({0, 0, p.x});
  }
  fine.skinning.push_back(binding);
  fine.targets.push_back(target);
  const scene::Mesh coarse = coarseOf(fine, 80);
  ASSERT_EQ(coarse.skinning[0].joints.size(), coarse.positions.size());
  ASSERT_EQ(coarse.targets[0].positions.size(), coarse.positions.size());
  for (std::size_t v = 0; v < coarse.positions.size(); ++v) {
    if (std::abs(coarse.positions[v].x) > 0.1f) {
      EXPECT_EQ(coarse.skinning[0].joints[v][0], coarse.positions[v].x > 0 ? 1 : 0);
    }
    EXPECT_NEAR(coarse.targets[0].positions[v].z, coarse.positions[v].x, 0.05f);
  }
}

TEST(Coarsen, RefusesWhatItCannotUse) {
  Workers workers(1);
  EXPECT_THROW(coarsenMesh(scene::Mesh{}, {500}, workers), std::invalid_argument);
  EXPECT_THROW(coarsenMesh(builtinMesh("icosphere:1"), {3}, workers), std::invalid_argument);
}

}  // namespace
}  // namespace limn::coarsen::test
