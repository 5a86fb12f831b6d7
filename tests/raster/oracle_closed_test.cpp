// Closed surfaces: every sample is covered once per layer, with no crack between two triangles and no
// overlap.
//
// Triangles are drawn one by one, so that what lies behind another is seen as well. A ray that enters a
// closed surface leaves it again: at every pixel as many front faces as back faces are found, or it is not
// covered "exactly once".
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/raster/oracle_scene.h"

namespace limn::test {
namespace {

// How many of the front faces of `soup` cover each pixel, by drawing them alone.
std::vector<int> countLayers(raster::Renderer& renderer, const Soup& soup, const glm::mat4& modelToView,
                             const Projection& projection) {
  std::vector<int> layers(static_cast<std::size_t>(projection.width) * projection.height, 0);
  const raster::Material material;
  raster::Frame frame;
  frame.projection = projection;
  frame.materials = std::span(&material, 1);
  frame.samples = 1;
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
    Soup alone = soup;
    alone.indices.assign(soup.indices.begin() + 3 * t, soup.indices.begin() + 3 * t + 3);
    const raster::Geometry geometry = alone.geometry();
    raster::Draw draw;
    draw.geometry = &geometry;
    draw.modelToView = modelToView;
    frame.draws = std::span(&draw, 1);
    const Picture picture = render(renderer, frame);
    for (std::size_t pixel = 0; pixel < layers.size(); ++pixel) layers[pixel] += picture.ids[pixel] == 0;
  }
  return layers;
}

glm::mat4 randomPlacement(std::uint32_t seed, float distance) {
  Random random(seed);
  const glm::vec3 place(uniform(random, 0.0, 0.3), uniform(random, 0.0, 0.3), -distance);
  const glm::vec3 axis(uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0), uniform(random, 0.1, 1.0));
  return glm::rotate(glm::translate(glm::mat4(1.0f), place), static_cast<float>(uniform(random, 0.0, 6.0)),
                     glm::normalize(axis));
}

TEST(OracleClosed, AsManyFrontFacesAsBackFacesAtEveryPixel) {
  raster::Renderer renderer(1);
  const Soup soups[] = {sphere(10, 14), torus(18, 9, 0.4f)};
  for (const Soup& soup : soups) {
    const Soup backs = insideOut(soup);
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      Projection projection = perspectiveProjection(80, 80, 30.0, 1.0f, 100.0f);
      if (seed % 2 == 0) {
        projection.perspective = false;
        projection.pixelsX = projection.pixelsY = 25.0f;
      }
      const glm::mat4 placement = randomPlacement(seed, 6.0f);
      const std::vector<int> front = countLayers(renderer, soup, placement, projection);
      const std::vector<int> back = countLayers(renderer, backs, placement, projection);
      int covered = 0;
      for (std::size_t pixel = 0; pixel < front.size(); ++pixel) {
        ASSERT_EQ(front[pixel], back[pixel]) << "pixel " << pixel << ", seed " << seed;
        covered += front[pixel] > 0;
      }
      EXPECT_GT(covered, 80 * 80 / 6);
    }
  }
}

// A convex surface has one layer of front faces, without a hole.
TEST(OracleClosed, OneLayerOfASphere) {
  raster::Renderer renderer(1);
  const Projection projection = perspectiveProjection(90, 70, 30.0, 1.0f, 100.0f);
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const std::vector<int> layers =
        countLayers(renderer, sphere(12, 16), randomPlacement(seed, 5.0f), projection);
    for (int row = 0; row < 70; ++row) {
      int changes = 0;
      for (int column = 0; column < 90; ++column) {
        const int here = layers[row * 90 + column];
        ASSERT_LE(here, 1) << "pixel (" << column << ", " << row << "), seed " << seed;
        changes += here != (column == 0 ? 0 : layers[row * 90 + column - 1]);
      }
      EXPECT_LE(changes, 2) << "a hole in row " << row << ", seed " << seed;
    }
  }
}

// Seen from within, a surface fills the window; triangles behind the eye, across the near plane and far
// outside the window have to be clipped so that neighbours still meet.
TEST(OracleClosed, SeenFromWithinEveryPixelIsCoveredOnce) {
  raster::Renderer renderer(1);
  const Soup room = insideOut(sphere(5, 6));
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    // The eye near the middle of an ellipsoid.
    const glm::mat4 placement = glm::scale(randomPlacement(seed, 0.1f), glm::vec3(1.0f, 1.3f, 0.8f));
    // From a wide angle down to a telescope, which sends the corners a million pixels out.
    const double degrees[] = {120.0, 60.0, 5.0, 0.05};
    const Projection projection = perspectiveProjection(64, 48, degrees[seed % 4], 1e-3f, 100.0f);
    const std::vector<int> layers = countLayers(renderer, room, placement, projection);
    for (std::size_t pixel = 0; pixel < layers.size(); ++pixel) {
      ASSERT_EQ(layers[pixel], 1) << "pixel " << pixel << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace limn::test
