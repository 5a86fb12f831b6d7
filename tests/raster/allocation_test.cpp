// A frame like the one before it allocates nothing, and what the renderer holds is what it says.
#include <gtest/gtest.h>

#include <malloc.h>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include "raster/texture.h"
#include "tests/raster/fixture.h"

namespace {
std::atomic<std::uint64_t> allocations = 0;
std::atomic<std::int64_t> held = 0;  // bytes

void release(void* p) {
  held -= static_cast<std::int64_t>(malloc_usable_size(p));
  std::free(p);
}
void* counted(void* p) {
  if (p == nullptr) throw std::bad_alloc();
  ++allocations;
  held += static_cast<std::int64_t>(malloc_usable_size(p));
  return p;
}
}  // namespace

// The replaceable allocation functions, counted. None is inlined, or g++ sees one of a pair only and takes the other for
// the standard library's.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted(std::malloc(size == 0 ? 1 : size));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto a = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(a, (size + a - 1) / a * a));
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  release(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  release(p);
}

namespace limn::raster::test {
namespace {

// A frame whose tiles differ in what they need: triangles from one corner to the other ever more of them.
class UnevenFrame {
 public:
  explicit UnevenFrame(bool textured) : scene_(pixelProjection(512, 300)), picture_(512, 300) {
    for (int i = 0; i < 3000; ++i) {
      const float at = static_cast<float>(i) / 3000.0F, x = at * at * 480.0F - 240.0F,
                  y = at * 280.0F - 140.0F;
      soup_.triangle({x, y, -5.0F}, {x + 12.0F, y, -6.0F}, {x, y + 12.0F, -7.0F});
    }
    const std::vector<glm::vec2> texcoords(soup_.positions.size(), glm::vec2(0.5F));
    Vertices vertices;
    vertices.positions = soup_.positions, vertices.normals = soup_.normals, vertices.texcoords = texcoords;
    const Part part{0, 3000, 0};
    geometry_ = std::make_unique<Geometry>(vertices, soup_.indices, std::span(&part, 1));
    for (std::uint32_t t = 0; t < 3000; ++t)
      if (((replaced_[t / 64] >> (t % 64)) & 1U) != 0) {
        sources_.push_back(t);
        for (std::uint32_t k = 0; k < 3; ++k) indices_.push_back(soup_.indices[3 * t + k]);
      }
    Draw& draw = scene_.draws[0];
    draw.geometry = geometry_.get();
    draw.replaced = replaced_;
    draw.stream.indices = indices_;
    draw.stream.sourceTriangles = sources_;
    if (textured) scene_.materials[0].baseColorTexture = &texture_;
    lines_.points = linePoints_, lines_.colors = lineColors_;
    scene_.frame.lines = std::span(&lines_, 1);
    scene_.frame.draws = scene_.draws;
    scene_.frame.materials = scene_.materials;
    scene_.frame.lights = scene_.lights;
  }

  const Statistics& draw(Renderer& renderer, int samples) {
    scene_.frame.samples = samples;
    renderer.draw(scene_.frame, picture_.target(), &statistics_);
    return statistics_;
  }
  void blend() { scene_.materials[0].alphaMode = AlphaMode::kBlend; }

 private:
  Scene scene_;
  Picture picture_;
  Statistics statistics_;
  Soup soup_;
  std::unique_ptr<Geometry> geometry_;
  const std::vector<std::uint64_t> replaced_ = std::vector<std::uint64_t>(47, 0x0f0fU);
  std::vector<std::uint32_t> indices_, sources_;
  const std::vector<glm::vec3> linePoints_{{-200, -100, -1}, {200, 120, -1}};
  const std::vector<glm::vec4> lineColors_{{1, 1, 1, 1}};
  Lines lines_;
  Texture texture_{1, 1, std::vector<std::uint8_t>{9, 9, 9, 255}, Texture::Content::kSrgb, {}};
};

TEST(Allocation, NoneInASteadyFrameWhicheverThreadDrawsWhichTile) {
  for (const bool textured : {false, true})
    for (const int threads : {1, 2, 5})
      for (const int samples : {1, 4}) {
        UnevenFrame frame(textured);
        Renderer renderer(threads);
        // A thread that comes late may allocate once, in the library that it comes from.
        int drawn = 0, quiet = 0;
        for (std::uint64_t before = allocations; quiet < 40 && drawn < 400; ++drawn, before = allocations) {
          frame.draw(renderer, samples);
          quiet = allocations == before ? quiet + 1 : 0;
        }
        EXPECT_EQ(quiet, 40) << threads << " threads, " << samples << " samples, " << drawn << " frames";
      }
}

TEST(Allocation, StatisticsKnowWhatTheRendererHolds) {
  for (const bool blended : {false, true}) {
    UnevenFrame frame(true);
    if (blended) frame.blend();
    const std::int64_t before = held;
    Renderer renderer(2);
    frame.draw(renderer, 4);
    const auto told = static_cast<double>(frame.draw(renderer, 4).scratchBytes);
    EXPECT_NEAR(told, static_cast<double>(held - before), 0.01 * told + 20000.0);
  }
}

}  // namespace
}  // namespace limn::raster::test
