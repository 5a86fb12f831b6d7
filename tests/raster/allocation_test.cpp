// A frame like the one before it allocates nothing.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/raster/fixture.h"

namespace {
std::atomic<std::uint64_t> allocations = 0;
}

// The replaceable allocation functions, counted.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto a = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace limn::raster::test {
namespace {

TEST(Allocation, NoneInASteadyFrame) {
  Soup soup;
  for (int i = 0; i < 500; ++i) {
    const auto x = static_cast<float>(i % 25) * 10.0F - 120.0F, y = static_cast<float>(i / 25) * 8.0F - 80.0F;
    soup.triangle({x, y, -5.0F}, {x + 12.0F, y, -6.0F}, {x, y + 12.0F, -7.0F});
  }
  const Geometry geometry = soup.geometry();
  Scene scene(pixelProjection(256, 160));
  const std::vector<std::uint64_t> replaced(8, 0x0f0fU);
  std::vector<std::uint32_t> streamIndices, sources;
  for (std::uint32_t t = 0; t < 500; ++t)
    if (((replaced[t / 64] >> (t % 64)) & 1U) != 0) {
      sources.push_back(t);
      for (std::uint32_t k = 0; k < 3; ++k) streamIndices.push_back(soup.indices[3 * t + k]);
    }
  scene.draws[0].geometry = &geometry;
  scene.draws[0].replaced = replaced;
  scene.draws[0].stream.indices = streamIndices;
  scene.draws[0].stream.sourceTriangles = sources;
  scene.frame.draws = scene.draws;
  scene.frame.materials = scene.materials;
  scene.frame.lights = scene.lights;
  Picture picture(256, 160);
  Renderer renderer(2);
  Statistics statistics;
  for (int i = 0; i < 30; ++i) renderer.draw(scene.frame, picture.target(), &statistics);
  const std::uint64_t before = allocations;
  for (int i = 0; i < 10; ++i) renderer.draw(scene.frame, picture.target(), &statistics);
  EXPECT_EQ(allocations - before, 0U);
}

}  // namespace
}  // namespace limn::raster::test
