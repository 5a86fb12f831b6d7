// The same picture for any number of threads and any tile size.
#include <gtest/gtest.h>

#include <random>

#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

Soup randomSoup(std::uint32_t seed, int count, float extent, float size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-extent, extent), offset(-size, size);
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 a{place(random), place(random), -2.0F - std::abs(place(random))};
    const auto corner = [&] {
      return soup.vertex(a + glm::vec3{offset(random), offset(random), offset(random)},
                         {offset(random), offset(random), size});
    };
    for (int k = 0; k < 3; ++k) soup.indices.push_back(corner());
  }
  return soup;
}

TEST(Determinism, ThreadsAndTileSizesChangeNothing) {
  const Geometry geometry = randomSoup(3, 2000, 4.0F, 0.7F).geometry();
  const Geometry close = randomSoup(4, 60, 3.0F, 9.0F).geometry();
  Scene scene({true, 150.0F, 150.0F, 0.5F, 100.0F, 301, 203});
  scene.draws.resize(2);
  scene.draws[0].geometry = &geometry;
  scene.draws[1].geometry = &close;
  scene.draws[1].firstId = 2000;
  scene.materials[0].doubleSided = true;
  for (const int samples : {1, 4, 8}) {
    scene.frame.samples = samples;
    Renderer one(1);
    const Picture expected = scene.draw(one);
    for (const int threads : {2, 3, 8, 32}) {
      Renderer renderer(threads);
      EXPECT_TRUE(scene.draw(renderer) == expected) << threads << " threads, " << samples << " samples";
    }
    for (const Tuning tuning : {Tuning{16, 1}, Tuning{32, 64}, Tuning{64, 33}, Tuning{128, 16}}) {
      Renderer renderer(2, tuning);
      EXPECT_TRUE(scene.draw(renderer) == expected) << tuning.tileWidth << "x" << tuning.tileHeight;
    }
  }
}

}  // namespace
}  // namespace limn::raster::test
