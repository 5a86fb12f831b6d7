// What is drawn over opaque surfaces: blended triangles in their order, and lines.
#include <gtest/gtest.h>

#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

Part all(const Soup& soup, std::uint32_t material) {
  return {0, static_cast<std::uint32_t>(soup.indices.size() / 3), material};
}

Geometry geometryOf(const Soup& soup, const Part& part) {
  Vertices v;
  v.positions = soup.positions;
  v.normals = soup.normals;
  return Geometry(v, soup.indices, std::span(&part, 1));
}

Soup square(float z) {
  Soup soup;
  soup.triangle({-20, -20, z}, {20, -20, z}, {20, 20, z});
  soup.triangle({-20, -20, z}, {20, 20, z}, {-20, 20, z});
  return soup;
}

TEST(Blending, FarToNearWhateverTheOrderOfDraws) {
  const Soup nearSquare = square(-1), farSquare = square(-5);
  const Geometry front = geometryOf(nearSquare, all(nearSquare, 0)),
                 back = geometryOf(farSquare, all(farSquare, 1));
  Scene scene(pixelProjection(16, 16));
  scene.materials.resize(2);
  for (Material& m : scene.materials) m.unlit = true, m.alphaMode = AlphaMode::kBlend;
  scene.materials[0].baseColor = {1, 0, 0, 0.5F};
  scene.materials[1].baseColor = {0, 1, 0, 0.5F};
  scene.frame.background = {0, 0, 1, 1};
  scene.frame.encoding = Encoding::kNone;
  scene.draws.resize(2);
  Renderer renderer(1);
  for (const bool swapped : {false, true})
    for (const int samples : {1, 4, 8}) {
      scene.draws[0].geometry = swapped ? &front : &back;
      scene.draws[1].geometry = swapped ? &back : &front;
      scene.frame.samples = samples;
      const Picture p = scene.draw(renderer);
      // 0.5 red over 0.5 green over blue, on the triangles' shared diagonal too.
      for (std::size_t i = 0; i < p.rgba.size(); i += 4) {
        ASSERT_EQ(p.rgba[i], 128);
        ASSERT_EQ(p.rgba[i + 1], 64);
        ASSERT_EQ(p.rgba[i + 2], 64);
        ASSERT_EQ(p.rgba[i + 3], 255);
      }
    }
}

TEST(Lines, CoverTheirWidthAndHideBehindSurfaces) {
  const Soup soup = square(-5);
  const Geometry geometry = geometryOf(soup, all(soup, 0));
  Scene scene(pixelProjection(40, 40));
  scene.materials[0].unlit = true;
  scene.materials[0].baseColor = {0, 0, 0, 1};
  scene.frame.encoding = Encoding::kNone;
  scene.draws[0].geometry = &geometry;
  const std::vector<glm::vec4> colors{{1, 1, 1, 1}};
  const auto brightness = [&](float z, float width) {
    const std::vector<glm::vec3> points{{-10, -7, z}, {10, 5, z}};
    Lines lines;
    lines.points = points;
    lines.colors = colors;
    lines.width = width;
    scene.frame.lines = std::span(&lines, 1);
    Renderer renderer(2);
    const Picture p = scene.draw(renderer);
    double sum = 0.0;
    for (std::size_t i = 0; i < p.rgba.size(); i += 4) sum += p.rgba[i] / 255.0;
    return sum;
  };
  const double length = std::sqrt(20.0 * 20.0 + 12.0 * 12.0);
  EXPECT_NEAR(brightness(-4, 3) / (3 * length + 2.25 * 3.1416), 1.0, 0.03);  // round ends
  EXPECT_NEAR(brightness(-5, 3), brightness(-4, 3), 1e-9);                   // on the surface
  EXPECT_EQ(brightness(-6, 3), 0.0);                                         // behind it
  EXPECT_NEAR(brightness(-4, 0.5F) / brightness(-4, 1), 0.5, 0.02);
}

TEST(Lines, OnAnEdgeOfASteepFaceAreSeen) {
  Soup soup;
  soup.triangle({-15, -15, -500}, {15, -15, -500}, {0, 15, -5});
  const Geometry geometry = soup.geometry();
  Scene scene(pixelProjection(40, 40));
  scene.materials[0].unlit = true;
  scene.materials[0].baseColor = {0, 0, 0, 1};
  scene.frame.encoding = Encoding::kNone;
  scene.frame.background = {0, 0, 0, 1};
  scene.draws[0].geometry = &geometry;
  const std::vector<glm::vec4> colors{{1, 1, 1, 1}};
  const std::vector<glm::vec3> points{{-15, -15, -500}, {0, 15, -5}};
  Lines lines;
  lines.points = points;
  lines.colors = colors;
  lines.width = 2;
  scene.frame.lines = std::span(&lines, 1);
  Renderer renderer(1);
  const Picture p = scene.draw(renderer);
  for (int y = 8; y < 32; ++y) {
    double row = 0.0;
    for (int x = 0; x < 40; ++x) row += p.rgba[4 * p.at(x, y)] / 255.0;
    EXPECT_NEAR(row, 2.0 * std::sqrt(1.25), 0.2) << y;
  }
}

}  // namespace
}  // namespace limn::raster::test
