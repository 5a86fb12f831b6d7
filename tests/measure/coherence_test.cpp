#include "bench/measure/coherence.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "raster/base/elementary.h"
#include "tests/measure/window.h"

namespace limn::measure {
namespace {

TEST(ChangeBetween, MovedEdgesAtAnyAngleIsTheWay) {
  for (int angle = 0; angle < 180; angle += 7) {
    for (const double way : {0.5, 2.0}) {
      const auto bar = [&](double by) {
        std::vector<glm::dvec2> points;
        const double a = angle * kPi / 180;
        const glm::dvec2 along(std::cos(a), std::sin(a)), across(-along.y, along.x);
        for (const glm::dvec2 corner : {glm::dvec2(-90, -30), {90, -30}, {90, 30 + by}, {-90, 30 + by}}) {
          points.push_back(glm::dvec2(128.3, 127.9) + along * corner.x + across * corner.y);
        }
        return drawnPolygon(points, 256);
      };
      const MaskChange change = changeBetween(bar(0.0), bar(way));
      EXPECT_NEAR(change.area, 180 * way, 1.0) << angle;
      EXPECT_NEAR(change.thickness, way, 1.0 / 8) << angle;
    }
  }
}

TEST(ChangeBetween, AThinNewPieceIsThin) {
  const Mask before = drawnPolygon(regularPolygon({64, 64}, 30, 50), 256);
  Mask after = before;
  std::vector<SampleTriangle> triangles;
  project(convexPolygon({{150, 20}, {200, 180}, {150.5, 20}}, 256), windowCamera(256), triangles);
  after.draw(triangles);
  EXPECT_GT(changeBetween(before, after).area, 10.0);
  EXPECT_LT(changeBetween(before, after).thickness, 0.7);
  EXPECT_EQ(changeBetween(before, before).thickness, 0.0);
}

TEST(Path, GoesItsArcInEqualSteps) {
  const Path path{6.0, 0.4};
  EXPECT_EQ(path.steps(), 15u);
  const double step = glm::distance(path.direction(0), path.direction(1));
  for (std::size_t i = 1; i < path.steps(); ++i) {
    EXPECT_NEAR(glm::distance(path.direction(i), path.direction(i + 1)), step, 1e-12);
  }
}

// A ball turned about its centre has the same outline in every frame, and an exact mesh of it does not pop.
TEST(Coherence, OfAFineSphereIsNothing) {
  Subject subject;
  subject.meshes = loadMeshes("builtin:icosphere:6");
  subject.flat = subject.truth = surfaceOf(subject.meshes);
  subject.bounds = {{0, 0, 0}, 1.0};
  Variant flat{"flat", {}};
  flat.parameters.method = silhouette::Method::kFlat;
  Workers workers(2);
  const Coherence coherence = measureCoherence(subject, {flat}, {2.0, 0.4}, 256, workers).front();
  EXPECT_EQ(coherence.pop, 0.0);
  EXPECT_LT(coherence.change, 0.01);
}

// What the flat mesh of a coarse ball changes in a step grows with the step.
TEST(Coherence, ChangeGrowsWithTheStep) {
  const Subject subject = loadSubject(makePair("builtin:icosphere-320", ""));
  Variant flat{"flat", {}};
  flat.parameters.method = silhouette::Method::kFlat;
  Workers workers(2);
  const double small = measureCoherence(subject, {flat}, {2.0, 0.25}, 256, workers).front().pop;
  const double large = measureCoherence(subject, {flat}, {2.0, 1.0}, 256, workers).front().pop;
  EXPECT_GT(small, 0.0);
  EXPECT_NEAR(large / small, 4.0, 1.5);
}

// Silhouette curves at 0.05 degrees a step: nothing jumps by more than the tolerance, the concave inner rim of the torus
// and the crossings of the knot included. (1 / 16 pixel is what the masks tell apart.)
TEST(Coherence, CurvesDoNotPop) {
  Workers workers(2);
  for (const char* model : {"builtin:sphere-200", "builtin:torus-576", "builtin:knot-480"}) {
    Variant curves{"curves", {}};
    curves.parameters.method = silhouette::Method::kCurves;
    curves.parameters.tolerance = 0.125f;
    const Coherence coherence =
        measureCoherence(loadSubject(makePair(model, "")), {curves}, {1.5, 0.05}, 512, workers).front();
    EXPECT_LE(coherence.localPop, 0.125 + 1.0 / 16) << model;
    EXPECT_LT(coherence.pop, 0.0125) << model;
  }
}

}  // namespace
}  // namespace limn::measure
