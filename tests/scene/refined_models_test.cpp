// What a refined stream promises, on models that nobody here wrote: it is as closed as the mesh to the last bit, and
// every edge's polyline stays within the tolerance of its exact curve, and the curve of it, by dense samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "../silhouette/shapes.h"
#include "apps/scene/camera.h"
#include "apps/scene/load.h"
#include "apps/scene/pose.h"
#include "model_files.h"
#include "silhouette/edge_curves.h"

namespace limn::scene {
namespace {

using glm::dvec2;
using glm::dvec3;
using silhouette::CurveOffsets;
using silhouette::View;

constexpr std::size_t kMostTriangles = 1500;

dvec2 project(const View& view, const dvec3& p) {
  const dvec3 v(glm::dmat4(view.modelToView) * glm::dvec4(p, 1.0));
  const double w = view.projection.perspective ? -v.z : 1.0;
  return dvec2(v.x * view.projection.pixelsX, v.y * view.projection.pixelsY) / w;
}

double distanceTo(const dvec2& point, const std::vector<dvec2>& polyline) {
  double nearest = 1e300;
  for (std::size_t k = 1; k < polyline.size(); ++k) {
    const dvec2 a = polyline[k - 1], ab = polyline[k] - a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(point - a, ab) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, glm::length(point - (a + t * ab)));
  }
  return nearest;
}

/// The stream's vertices on each edge in its direction, as its first face has them.
std::vector<std::vector<std::pair<float, glm::vec3>>> edgeVerticesOf(
    const silhouette::Topology& topology, const silhouette::RefinedStream& stream) {
  std::vector<std::vector<std::pair<float, glm::vec3>>> found(topology.edges().size());
  for (std::size_t i = 0; i < stream.positions.size(); ++i) {
    const silhouette::Origin& origin = stream.origins[i];
    const float v = origin.weights.x, w = origin.weights.y;
    const std::uint32_t side = w == 0.0f ? 0 : v == 0.0f ? 2 : 1;
    if (side == 1 && std::fabs(1.0f - v - w) > 1e-6f) continue;  // inside
    const std::uint32_t e = topology.sideEdges()[3 * origin.triangle + side];
    const silhouette::Edge& edge = topology.edges()[e];
    if (edge.faces[0].triangle != origin.triangle || edge.faces[0].side != side) continue;
    const float along = side == 0 ? v : side == 1 ? w : 1.0f - w;
    found[e].emplace_back(edge.runsBack(0) ? 1.0f - along : along, stream.positions[i]);
  }
  for (auto& vertices : found)
    std::sort(vertices.begin(), vertices.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
  return found;
}

class RefinedModels : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    scene_ = load(GetParam());
    if (scene_.meshes.size() != 1 || scene_.meshes[0].indices.size() / 3 > kMostTriangles)
      GTEST_SKIP() << "too large";
    Pose pose;
    evaluatePose(scene_, -1, 0.0, pose);
    bounds_ = boundingSphere(scene_, pose);
    toWorld_ = pose.instances[0].toWorld;
    const Mesh& mesh = scene_.meshes[0];
    shape_ = {mesh.positions, mesh.normals, mesh.indices};
  }

  /// From all around, near and far, and without perspective.
  std::vector<View> views() const {
    std::vector<View> all;
    for (int k = 0; k < 3; ++k) {
      LookAt look = frameSphere(bounds_, 700, 500, 40.0 + 115.0 * k, 25.0 - 30.0 * k, k == 1 ? 2.5 : 1.0,
                                30.0, k == 2 ? 2.2 * bounds_.radius : 0.0);
      const CameraView camera = makeCamera(look, bounds_, 700, 500);
      all.push_back(silhouette::makeView(camera.projection, camera.worldToView * toWorld_));
    }
    return all;
  }

  Scene scene_;
  Sphere bounds_;
  glm::dmat4 toWorld_{1.0};
  silhouette::Mesh shape_;
};

TEST_P(RefinedModels, AreAsClosedAsTheMeshAndWithinTheTolerance) {
  const silhouette::Topology topology(shape_);
  Workers workers(1);
  silhouette::Refiner refiner(shape_, topology, workers);
  silhouette::RefinedStream stream;
  stream.clear(shape_.triangleCount());
  const std::size_t open = silhouette::test::openSides(silhouette::test::drawnTriangles(shape_, stream));
  silhouette::Parameters parameters;
  silhouette::RobustEnds robust;
  std::vector<CurveOffsets> curves;
  std::vector<float> alphas;
  silhouette::computeEdgeCurves(shape_, topology, {parameters.tangents, parameters.robust},
                                silhouette::Crew(0), robust, curves);
  for (const View& view : views()) {
    refiner.refine(view, parameters, stream);
    EXPECT_TRUE(stream.isConsistent(shape_));
    EXPECT_EQ(silhouette::test::openSides(silhouette::test::drawnTriangles(shape_, stream)), open);

    refiner.silhouetteness(view, parameters, alphas);
    const auto vertices = edgeVerticesOf(topology, stream);
    for (std::size_t e = 0; e < alphas.size(); ++e) {
      if (alphas[e] == 0.0f) {
        EXPECT_TRUE(vertices[e].empty());
        continue;
      }
      const auto ends = silhouette::edgeVertices(shape_, topology.edges()[e])[0];
      const dvec3 p(shape_.positions[ends[0]]), q(shape_.positions[ends[1]]);
      const double alpha = static_cast<double>(alphas[e]);
      const dvec3 d0 = alpha * dvec3(curves[e][0]), d1 = alpha * dvec3(curves[e][1]);
      std::vector<dvec2> polyline{project(view, p)}, curve;
      for (const auto& [t, position] : vertices[e]) polyline.push_back(project(view, dvec3(position)));
      polyline.push_back(project(view, q));
      for (int k = 0; k <= 64; ++k) {
        const double t = k / 64.0, s = 1.0 - t;
        curve.push_back(project(view, s * p + t * q + 3.0 * s * t * (s * d0 + t * d1)));
      }
      // Roundings of the stream's positions; the sampled curve cuts its own corners.
      const double allowed = 1.002 * static_cast<double>(parameters.tolerance) + 2e-3;
      for (const dvec2& point : curve) ASSERT_LE(distanceTo(point, polyline), allowed) << "edge " << e;
      for (std::size_t k = 1; k < polyline.size(); ++k)
        for (int i = 0; i <= 4; ++i)
          ASSERT_LE(distanceTo(polyline[k - 1] + (i / 4.0) * (polyline[k] - polyline[k - 1]), curve), allowed)
              << "edge " << e;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RefinedModels, testing::ValuesIn(smallModels()), testNameOf);

}  // namespace
}  // namespace limn::scene
