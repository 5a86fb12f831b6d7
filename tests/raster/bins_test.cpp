// More than tiles can list is refused before it is listed.
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "raster/front_end.h"
#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

TEST(Bins, RefuseMoreThanTheyCount) {
  const Tiling tiling(16384, 16384, 128, 64);
  const TileRect all{0, 0, 128, 256};
  Bins bins;
  bins.reset(tiling);
  for (std::uint64_t i = 0; i < Bins::kMostItems / tiling.count(); ++i) bins.count(i % kRanges, all);
  bins.count(0, {0, 0, 1, 1});
  EXPECT_THROW(bins.allocate(), std::length_error);
  EXPECT_LT(bins.memoryBytes(), std::size_t{64} << 20U);
}

TEST(Bins, RefuseMoreOfOneTileThanRecordsNumber) {
  const Tiling tiling(100, 50, 128, 64);
  Bins bins;
  bins.reset(tiling);
  for (std::uint64_t i = 0; i <= Bins::kMostOfTile; ++i) bins.count(i % kRanges, {0, 0, 1, 1});
  EXPECT_THROW(bins.allocate(), std::length_error);
}

// 140,000 instances that each fill a window of 32,768 tiles: 4.6e9 places in their lists.
TEST(Effort, IsFoundExcessiveBeforeTilesListAnything) {
  constexpr int kSize = 16384;
  Soup soup;
  soup.triangle({-8192, -8192, -5}, {8192, -8192, -5}, {-8192, 8192, -5});
  const Geometry geometry = soup.geometry();
  Draw draw;
  draw.geometry = &geometry;
  const std::vector<Draw> draws(140000, draw);
  const std::vector<Material> materials(1);
  Frame frame;
  frame.projection = pixelProjection(kSize, kSize);
  frame.draws = draws;
  frame.materials = materials;
  frame.samples = 1;
  frame.effortLimit = 1e12;
  // Never touched: no memory stands behind it.
  const auto rgba = std::make_unique_for_overwrite<std::uint8_t[]>(4UL * kSize * kSize);
  Target target;
  target.rgba = rgba.get(), target.rgbaStride = 4UL * kSize;
  Renderer renderer(2);
  EXPECT_THROW(renderer.draw(frame, target), TooMuchEffort);
}

}  // namespace
}  // namespace limn::raster::test
