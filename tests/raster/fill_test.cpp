// The fill rule: shared edges and vertices leave no gap and cover nothing twice; equal depths go to the
// first.
#include <gtest/gtest.h>

#include <random>

#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

// A triangulated grid with jittered inner vertices over the whole window: every pixel must be covered, each
// by one triangle, so the covered pixels of its triangles drawn one by one sum up to the window.
TEST(Fill, ATriangulationCoversEveryPixelOnce) {
  constexpr int kSize = 96, kCells = 12;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> jitter(-3.0F, 3.0F);
  Soup soup;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x) {
      const bool inner = x > 0 && y > 0 && x < kCells && y < kCells;
      const float px = static_cast<float>(x) * 8.0F - 48.0F + (inner ? jitter(random) : 0.0F);
      const float py = static_cast<float>(y) * 8.0F - 48.0F + (inner ? jitter(random) : 0.0F);
      soup.vertex({px, py, -1.0F});
    }
  for (std::uint32_t y = 0; y < kCells; ++y)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t a = y * (kCells + 1) + x, b = a + 1, c = a + kCells + 1, d = c + 1;
      for (const std::uint32_t i : {a, b, d, a, d, c}) soup.indices.push_back(i);
    }
  Renderer renderer(2);
  Scene scene(pixelProjection(kSize, kSize));
  scene.frame.samples = 1;
  std::uint64_t covered = 0;
  for (std::size_t t = 0; t < soup.indices.size(); t += 3) {
    Soup one = soup;
    one.indices.assign(soup.indices.begin() + static_cast<std::ptrdiff_t>(t),
                       soup.indices.begin() + static_cast<std::ptrdiff_t>(t) + 3);
    const Geometry geometry = one.geometry();
    scene.draws[0].geometry = &geometry;
    Statistics statistics;
    scene.draw(renderer, &statistics);
    covered += statistics.pixelsCovered;
  }
  EXPECT_EQ(covered, static_cast<std::uint64_t>(kSize) * kSize);
  const Geometry whole = soup.geometry();
  scene.draws[0].geometry = &whole;
  const Picture picture = scene.draw(renderer);
  for (const std::uint32_t id : picture.ids) ASSERT_NE(id, kNoId);
}

TEST(Fill, PixelCentresOnEdgesFollowTheTopLeftRule) {
  // The square [-2, 2)² in pixels with corners on pixel centres: rows and columns 1 … 4 of 6, without the
  // last ones.
  Soup soup;
  soup.triangle({-1.5F, -2.5F, -1}, {2.5F, -2.5F, -1}, {2.5F, 1.5F, -1});
  soup.triangle({-1.5F, -2.5F, -1}, {2.5F, 1.5F, -1}, {-1.5F, 1.5F, -1});
  const Geometry geometry = soup.geometry();
  Renderer renderer(1);
  Scene scene(pixelProjection(6, 6));
  scene.frame.samples = 1;
  scene.draws[0].geometry = &geometry;
  const Picture picture = scene.draw(renderer);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 6; ++x)
      EXPECT_EQ(picture.ids[picture.at(x, y)] != kNoId, x >= 1 && x < 5 && y >= 1 && y < 5) << x << ' ' << y;
}

TEST(Fill, EqualDepthsGoToTheTriangleSubmittedFirst) {
  Soup soup;
  for (int i = 0; i < 5; ++i) soup.triangle({-8, -8, -1}, {8, -8, -1}, {0, 8, -1});
  const Geometry geometry = soup.geometry();
  Renderer renderer(2);
  Scene scene(pixelProjection(16, 16));
  scene.draws.resize(2);
  scene.draws[0].geometry = scene.draws[1].geometry = &geometry;
  scene.draws[0].firstId = 100;
  scene.draws[1].firstId = 200;
  for (const std::uint32_t id : scene.draw(renderer).ids) EXPECT_TRUE(id == 100 || id == kNoId);
}

}  // namespace
}  // namespace limn::raster::test
