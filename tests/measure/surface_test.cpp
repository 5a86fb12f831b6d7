#include "bench/measure/surface.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "bench/measure/outline.h"
#include "bench/measure/views.h"
#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

constexpr double kPixel = 1.0 / 440;  // of a model of radius 1 in the standard set-up

TEST(StandardDirections, AreTwentySixUnitVectorsOffEveryAxis) {
  const auto directions = standardDirections();
  ASSERT_EQ(directions.size(), 26u);
  for (const glm::dvec3& d : directions) {
    EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
    EXPECT_LT(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), 0.9999);
  }
}

TEST(RandomDirections, RepeatWithTheirSeed) {
  const auto directions = randomDirections(5, 100);
  ASSERT_EQ(directions.size(), 100u);
  EXPECT_EQ(directions, randomDirections(5, 100));
  EXPECT_NE(directions, randomDirections(6, 100));
}

TEST(AnalyticSurface, StatesAnErrorFarBelowTheMasks) {
  EXPECT_LT(sphereSurface({1, 2, 3}, 1.0).error, kPixel / 30);
  EXPECT_LT(torusSurface({0, 0, 0}, 0.7, 0.3, 2).error, kPixel / 30);
  EXPECT_LT(coneSurface({0, 0, 0}, {0, 0, 1}, 1.0).error, kPixel / 30);
  EXPECT_LT(knotSurface({0, 0, 0}, 1.0).error, 3.7 * kPixel / 30);
}

// The picture of a sphere is known: at the standard camera a disc of 0.95 half windows.
TEST(OutlineCamera, SphereIsADiscThatFillsTheWindowButFiveHundredths) {
  const glm::dvec3 center{4.0, -2.0, 1.0};
  const AnalyticSurface sphere = sphereSurface(center, 3.0);
  for (const glm::dvec3& direction : randomDirections(3, 4)) {
    const scene::CameraView camera = outlineCamera({center, 3.0}, direction, 1024);
    std::vector<SampleTriangle> triangles;
    project(sphere.surface, camera, triangles);
    Mask mask(1024, 1024);
    mask.draw(triangles);
    const double radius = 0.95 * 512;
    EXPECT_NEAR(mask.area() / (kPi * radius * radius), 1.0, 1e-4);
    EXPECT_NEAR(length(traceOutline(mask)) / (2 * kPi * radius), 1.0, 1e-3);
  }
}

TEST(BoundingSphere, IsTightOnSpheresAndHoldsEverything) {
  const scene::Sphere sphere = boundingSphere(sphereSurface({5, 6, 7}, 2.0).surface);
  EXPECT_GE(sphere.radius, 2.0 - 1e-9);
  EXPECT_LE(sphere.radius, 2.02);
  EXPECT_LT(glm::distance(sphere.center, glm::dvec3(5, 6, 7)), 0.02);
}

// Every vertex of a coarse tessellation lies on the surface that is found for it.
TEST(RecognizeAnalytic, FindsTheSurfaceOfATessellation) {
  const auto sparse = [](const Surface& fine, std::size_t every) {
    Surface coarse;
    for (std::size_t i = 0; i < fine.positions.size(); i += every)
      coarse.positions.push_back(fine.positions[i]);
    return coarse;
  };
  const auto radiusOf = [](const AnalyticSurface& found) { return boundingSphere(found.surface).radius; };
  // Symmetric subsets: whole rings of every eighth side.
  EXPECT_NEAR(radiusOf(recognizeAnalytic(sparse(torusSurface({1, 0, 2}, 0.7, 0.3, 1).surface, 32))), 1.0,
              0.01);
  EXPECT_NEAR(radiusOf(recognizeAnalytic(sparse(coneSurface({0, 0, -1}, {0, 0, 1}, 1.0).surface, 1))), 1.25,
              0.25);
  EXPECT_GT(recognizeAnalytic(sparse(knotSurface({0, 0, 0}, 1.0).surface, 1000)).surface.triangleCount(),
            100000u);
  Surface cube;
  for (int i = 0; i < 8; ++i) cube.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  cube.positions.emplace_back(0.5, 0.5, 0.5);
  EXPECT_THROW(recognizeAnalytic(cube), std::invalid_argument);
}

}  // namespace
}  // namespace limn::measure
