#include "bench/measure/accuracy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/coarsen/coarsen.h"
#include "apps/scene/builtin.h"
#include "bench/measure/views.h"
#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

constexpr int kSize = 512;

Variant variant(silhouette::Method method) {
  Variant out{"", {}};
  out.parameters.method = method;
  return out;
}

Subject icosphereAgainstSphere(double trueRadius) {
  Subject subject;
  subject.meshes = loadMeshes("builtin:icosphere:5");
  subject.flat = surfaceOf(subject.meshes);
  subject.truth = sphereSurface({0, 0, 0}, trueRadius).surface;
  subject.bounds = {{0, 0, 0}, trueRadius};
  return subject;
}

// The whole way from meshes to figures: two spheres whose pictures are discs of known radii.
TEST(Accuracy, OfASphereAgainstALargerOneIsTheDifferenceOfTheirPictures) {
  Workers workers(2);
  for (const double trueRadius : {1.0, 1.002, 1.02, 0.99}) {
    const Accuracy accuracy =
        measureAccuracy(icosphereAgainstSphere(trueRadius), {variant(silhouette::Method::kFlat)},
                        randomDirections(1, 3), kSize, workers);
    const double halfHeight = std::tan(kPi / 12), pixels = kSize / 2 / halfHeight;
    const double sineOfTruth = std::sin(std::atan(0.95 * halfHeight));
    const double truth = 0.95 * kSize / 2;
    const double drawn = pixels * std::tan(std::asin(sineOfTruth / trueRadius));
    for (const ViewFigures& view : accuracy.methods[0]) {
      EXPECT_NEAR(view.mean, std::abs(drawn * drawn - truth * truth) / (2 * truth), 1.0 / 16);
      EXPECT_NEAR(view.max, std::abs(drawn - truth), 1.0 / 8);  // the icosphere's own chords: 1/16
      EXPECT_NEAR(view.p95, std::abs(drawn - truth), 1.0 / 8);
      EXPECT_EQ(view.triangles, 20480u);
    }
  }
}

// Fitted curves are part of what is measured: without them the same mesh is further from the fine one.
TEST(Accuracy, OfAFittedModelIsThatOfItsCurves) {
  Workers workers(2);
  const scene::Mesh fine = scene::makeBuiltin("torus:32:16").meshes.at(0);
  const scene::Mesh small = coarsen::coarsenMesh(fine, {100}, workers);
  Subject subject;
  subject.meshes = {{glm::dvec3(0.0), small.positions, small.normals, small.indices, small.curves}};
  subject.flat = surfaceOf(subject.meshes);
  const std::vector<PlacedMesh> truth{{glm::dvec3(0.0), fine.positions, fine.normals, fine.indices, {}}};
  subject.truth = surfaceOf(truth);
  subject.bounds = boundingSphere(subject.truth);
  const auto offsets = [&] {
    return measureAccuracy(subject, {variant(silhouette::Method::kPatches)}, randomDirections(5, 4), kSize,
                           workers)
        .methods[0];
  };
  const std::vector<ViewFigures> fitted = offsets();
  subject.meshes[0].curves = {};
  const std::vector<ViewFigures> guessed = offsets();
  for (std::size_t view = 0; view < fitted.size(); ++view)
    EXPECT_LT(fitted[view].mean, 0.8 * guessed[view].mean) << "view " << view;
}

TEST(Accuracy, OfFlatIsThatOfTheCoarseMesh) {
  Workers workers(2);
  const Subject subject = loadSubject(makePair("builtin:sphere-200", ""));
  const Accuracy accuracy =
      measureAccuracy(subject, {variant(silhouette::Method::kFlat), variant(silhouette::Method::kPatches)},
                      randomDirections(2, 3), kSize, workers);
  for (std::size_t view = 0; view < 3; ++view) {
    EXPECT_EQ(accuracy.methods[0][view].mean, accuracy.flat[view].mean);
    EXPECT_EQ(accuracy.methods[0][view].max, accuracy.flat[view].max);
    EXPECT_LT(accuracy.methods[1][view].mean, accuracy.flat[view].mean);
  }
}

TEST(Accuracy, IsTheSameForAnyNumberOfThreads) {
  const Subject subject = loadSubject(makePair("builtin:torus-576", ""));
  Workers one(1), three(3);
  const auto variants = std::vector{variant(silhouette::Method::kPatches)};
  const auto directions = randomDirections(4, 3);
  const Accuracy a = measureAccuracy(subject, variants, directions, 128, one);
  const Accuracy b = measureAccuracy(subject, variants, directions, 128, three);
  for (std::size_t view = 0; view < 3; ++view) {
    EXPECT_EQ(a.methods[0][view].mean, b.methods[0][view].mean);
    EXPECT_EQ(a.methods[0][view].p95, b.methods[0][view].p95);
    EXPECT_EQ(a.methods[0][view].max, b.methods[0][view].max);
    EXPECT_EQ(a.methods[0][view].corner, b.methods[0][view].corner);
    EXPECT_EQ(a.methods[0][view].triangles, b.methods[0][view].triangles);
  }
}

// Every built-in model lies on its truth: all its vertices, and so its bounds.
TEST(StandardPairs, OfBuiltinModelsHaveATruthAroundThem) {
  for (const Pair& pair : standardPairs("no-such-folder")) {
    const Subject subject = loadSubject(pair);
    EXPECT_TRUE(pair.analytic) << pair.name;
    EXPECT_GT(subject.truth.triangleCount(), 4000u) << pair.name;
    EXPECT_NEAR(boundingSphere(subject.flat).radius / subject.bounds.radius, 1.0, 0.03) << pair.name;
    EXPECT_LT(subject.truthError / subject.bounds.radius * 490, 1.0 / 20) << pair.name;
  }
}

}  // namespace
}  // namespace limn::measure
