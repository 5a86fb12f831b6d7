// Clusters hold the triangles that went in, and the front end counts and culls what it should.
#include "raster/cluster.h"

#include <gtest/gtest.h>

#include <random>

#include "raster/base/scratch.h"
#include "raster/batch.h"
#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

std::uint32_t below(std::mt19937& random, std::uint32_t count) {
  return static_cast<std::uint32_t>(random() % count);
}

// Triangles whose corners are near each other in the order of vertices, some of them degenerate.
std::vector<std::uint32_t> randomIndices(std::uint32_t seed, std::size_t triangles, std::uint32_t vertices) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> indices;
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::uint32_t near = below(random, vertices);
    for (int k = 0; k < 3; ++k) indices.push_back((near + below(random, 40)) % vertices);
  }
  return indices;
}

TEST(ClusterCutter, KeepsEveryTriangleInOrderAndItsMaterialTogether) {
  VertexNumbers numbers;
  numbers.reserve(700);
  ClusterSet set;  // used again, as from frame to frame
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    const std::size_t triangles = 900 * seed;
    const std::vector<std::uint32_t> indices = randomIndices(seed, triangles, 700);
    const auto materialOf = [](std::size_t t) { return static_cast<std::uint32_t>(t / 250 % 3); };
    ClusterCutter cutter(set, triangles, numbers);
    for (std::size_t t = 0; t < triangles; ++t)
      cutter.add(std::span(indices).subspan(3 * t, 3), materialOf(t));
    cutter.finish();
    ASSERT_TRUE(set.isConsistent());
    std::size_t next = 0;
    for (const Cluster& cluster : set.clusters)
      for (std::uint32_t t = 0; t < cluster.triangleCount; ++t, ++next) {
        ASSERT_EQ(cluster.material, materialOf(next));
        for (std::size_t k = 0; k < 3; ++k)
          ASSERT_EQ(set.vertices[cluster.firstVertex + set.corners[k][next]], indices[3 * next + k]);
      }
    ASSERT_EQ(next, triangles);
  }
}

TEST(ClusterCutter, VertexNumbersForgetClustersOfLongAgo) {
  VertexNumbers numbers;
  numbers.reserve(2);
  numbers.beginCluster();
  EXPECT_EQ(numbers.words().number(1, 5), 5U);
  EXPECT_TRUE(numbers.has(1));
  EXPECT_EQ(numbers.words().number(1, 6), 5U);
  EXPECT_FALSE(numbers.has(0));
  for (int i = 0; i < 1 << 24; ++i) {  // more than there are numbers of clusters
    numbers.beginCluster();
    ASSERT_FALSE(numbers.has(1)) << i;
  }
}

TEST(Batch, AClusterIsReplacedWhenAllOfItsTrianglesAre) {
  std::mt19937 random(4);
  Soup soup;
  for (int t = 0; t < 300; ++t) soup.triangle({t, 0, -1}, {t + 1, 0, -1}, {t, 1, -1});
  const Geometry geometry = soup.geometry();
  std::vector<std::uint64_t> replaced(5);
  Draw draw;
  draw.geometry = &geometry;
  draw.replaced = replaced;
  Batch batch;
  batch.draw = &draw;
  batch.set = &geometry.data().set;
  for (int round = 0; round < 2000; ++round) {
    // Whole runs of bits, and now and then a hole of one.
    const std::uint32_t first = below(random, 300), last = first + below(random, 301 - first);
    for (std::uint64_t& word : replaced) word = 0;
    for (std::uint32_t t = first; t < last; ++t) replaced[t / 64] |= std::uint64_t{1} << (t % 64);
    const std::uint32_t hole = below(random, 300);
    if (round % 2 == 0) replaced[hole / 64] &= ~(std::uint64_t{1} << (hole % 64));
    for (const Cluster& cluster : batch.set->clusters) {
      bool all = true;
      for (std::uint32_t t = 0; t < cluster.triangleCount; ++t)
        all &= batch.isReplaced(cluster.firstTriangle + t);
      ASSERT_EQ(batch.isReplaced(cluster), all) << round;
      for (std::uint32_t t = cluster.firstTriangle; t + 16 <= cluster.firstTriangle + cluster.triangleCount;
           ++t)
        for (std::uint32_t i = 0; i < 16; ++i)
          ASSERT_EQ((batch.replacedFrom(t) >> i) & 1U, batch.isReplaced(t + i) ? 1U : 0U) << round;
    }
  }
}

TEST(Statistics, TrianglesInAreThoseThatAreLeftAndThoseOfTheStream) {
  Soup soup;
  for (int t = 0; t < 100; ++t) soup.triangle({t, 0, -1}, {t + 1, 0, -1}, {t, 1, -1});
  const Geometry geometry = soup.geometry();
  const std::vector<std::uint64_t> replaced{0b1011,
                                            ~std::uint64_t{0}};  // bits beyond the last triangle do not count
  const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5}, sources{0, 1};
  Scene scene(pixelProjection(64, 64));
  scene.draws.resize(2);
  for (Draw& draw : scene.draws) draw.geometry = &geometry;
  scene.draws[0].replaced = replaced;
  scene.draws[0].stream.indices = indices;
  scene.draws[0].stream.sourceTriangles = sources;
  Renderer renderer(2);
  Statistics statistics;
  scene.draw(renderer, &statistics);
  EXPECT_EQ(statistics.trianglesIn, 100U - 3 - 36 + 2 + 100);
}

TEST(Statistics, EveryStageTakesTime) {
  Soup soup;
  for (int t = 0; t < 2000; ++t) {
    const auto x = static_cast<float>(t % 50) * 4 - 100, y = static_cast<float>(t / 50) * 4 - 80;
    soup.triangle({x, y, -500}, {x + 9, y, -500}, {x, y + 9, -500});  // clusters far from the near plane
  }
  const Geometry geometry = soup.geometry();
  Scene scene(pixelProjection(200, 160));
  scene.draws[0].geometry = &geometry;
  Renderer renderer(2);
  Statistics s;
  scene.draw(renderer, &s);
  EXPECT_GT(s.transformMs, 0.0);
  EXPECT_GT(s.setupMs, 0.0);
  EXPECT_GT(s.binningMs, 0.0);
  EXPECT_GT(s.visibilityMs, 0.0);
  EXPECT_GT(s.shadingMs, 0.0);
  EXPECT_GT(s.resolveMs, 0.0);
}

TEST(Scratch, EverySlotGetsRoomForTheLargest) {
  struct Slot {
    std::vector<int> a;
    std::vector<double> b;
  };
  std::vector<Slot> slots(3);
  slots[0].a.resize(100);
  slots[2].b.resize(50);
  levelCapacity(slots, &Slot::a, &Slot::b);
  for (const Slot& slot : slots) {
    EXPECT_GE(slot.a.capacity(), 100U);
    EXPECT_GE(slot.b.capacity(), 50U);
  }
  EXPECT_EQ(slots[1].a.size(), 0U);
  EXPECT_EQ(slots[0].a.size(), 100U);
}

}  // namespace
}  // namespace limn::raster::test
