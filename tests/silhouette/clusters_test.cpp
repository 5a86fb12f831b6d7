// Clusters and kernels find what looking at every edge finds.
#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <glm/geometric.hpp>
#include <random>

#include "shapes.h"
#include "silhouette/edge_clusters.h"
#include "silhouette/facing_kernel.h"
#include "silhouette/pixel_bound.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

TEST(FacingKernel, EveryTargetGivesTheScalarBits) {
  std::mt19937 random(1);
  const auto next = [&] { return static_cast<float>(random() % 2000001) / 1000000.0f - 1.0f; };
  constexpr std::size_t kCount = 203;
  std::vector<float> arrays[6], expected(kCount), expectedHeights(kCount), facings(kCount);
  for (auto& array : arrays)
    for (std::size_t i = 0; i < kCount; ++i) array.push_back(next());
  const VertexArrays vertices{arrays[0].data(), arrays[1].data(), arrays[2].data(),
                              arrays[3].data(), arrays[4].data(), arrays[5].data()};
  const vec3 eye(arrays[0][7], arrays[1][7], arrays[2][7]);  // on a vertex
  for (const bool perspective : {false, true}) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{15}, kCount}) {
      computeFacingsScalar(eye, perspective, vertices, count, expected.data());
      computeHeightsScalar(eye, perspective, vertices, count, expectedHeights.data());
      for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
        hwy::SetSupportedTargetsForTest(targets & -targets);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        computeFacings(eye, perspective, vertices, count, facings.data());
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_EQ(expected[i], facings[i]) << hwy::TargetName(targets & -targets);
        computeHeights(eye, perspective, vertices, count, facings.data());
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_EQ(expectedHeights[i], facings[i]) << hwy::TargetName(targets & -targets);
      }
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
  }
  EXPECT_EQ(expected[7], 0.0f);
}

// Every edge that a cluster passes over stays within the tolerance, and the others have the α of the edge test.
TEST(EdgeClusters, PassOverOnlyWhatDoesNotShow) {
  std::size_t passedOver = 0, found = 0;
  std::vector<Shape> shapes = allShapes();
  shapes.push_back(icosphere(4));
  for (const Shape& shape : shapes) {
    const Mesh mesh = shape.mesh();
    const Topology topology(mesh);
    for (const Silhouetteness silhouetteness :
         {Silhouetteness::kCrossing, Silhouetteness::kContour, Silhouetteness::kEdge}) {
      Parameters parameters;
      parameters.silhouetteness = silhouetteness;
      parameters.features = shape.name != "cube";
      const Crew crew(0);
      EdgeTest test;
      RobustEnds robust;
      EdgeClusters clusters;
      std::vector<CurveOffsets> curves;
      test.prepare(mesh, topology, parameters, crew);
      computeEdgeCurves(mesh, topology, {}, crew, robust, curves);
      clusters.build(mesh, topology);
      clusters.update(mesh, topology, test, curves, {}, parameters, crew);
      for (const View& view : someViews(4.0f)) {
        const EdgeClusters::Eye eye = clusters.eyeOf(view, parameters);
        const PixelBound bound(view);
        std::vector<float> alphas(kEdgesPerCluster);
        float scale = 0.0f;
        for (std::size_t c = 0; c < clusters.count(); ++c) {
          const std::uint64_t bends = clusters.classify(c, eye, test, alphas, scale);
          for (std::size_t i = 0; i < kEdgesPerCluster && c * kEdgesPerCluster + i < topology.edges().size();
               ++i) {
            const std::uint32_t e = clusters.edgeAt(c * kEdgesPerCluster + i);
            const float alpha = test.alpha(view, parameters, e);
            if ((bends >> i & 1) != 0) {
              ASSERT_EQ(alphas[i], alpha) << shape.name;
              ++found;
              continue;
            }
            const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, topology.edges()[e])[0];
            const vec3 &p = mesh.positions[ends[0]], &q = mesh.positions[ends[1]];
            const CurveOffsets d{alpha * curves[e][0], alpha * curves[e][1]};
            ASSERT_LE(bound.curveError(p, q, d).chord, parameters.tolerance) << shape.name;
            // What it would add to the midpoints of its triangles is a mean of six offsets.
            ASSERT_LE(bound.distance(p, p + 0.5f * (d[0] + d[1])), parameters.tolerance * 1.001f)
                << shape.name;
            ++passedOver;
          }
        }
      }
    }
  }
  EXPECT_GT(passedOver, 1000u);
  EXPECT_GT(found, 1000u);
}

}  // namespace
}  // namespace limn::silhouette::test
