// Every instruction set that the machine has gives the pixels of the plain C++ definition, bit for bit.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>

#include "raster/texture.h"
#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

// The bits of the SSE4, AVX2 and AVX-512 that this machine has, one by one.
std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> all;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) all.push_back(left & -left);
  return all;
}

void expectSameOnEveryTarget(Scene& scene, const char* what) {
  Renderer scalar(2, Tuning{.scalar = true});
  Statistics expectedCounts, counts;
  const Picture expected = scene.draw(scalar, &expectedCounts);
  for (const std::int64_t target : targets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    Renderer renderer(2);
    const Picture picture = scene.draw(renderer, &counts);
    EXPECT_TRUE(picture.ids == expected.ids) << what << ' ' << hwy::TargetName(target);
    EXPECT_TRUE(picture.depth == expected.depth) << what << ' ' << hwy::TargetName(target);
    EXPECT_TRUE(picture.normals == expected.normals) << what << ' ' << hwy::TargetName(target);
    EXPECT_TRUE(picture.rgba == expected.rgba) << what << ' ' << hwy::TargetName(target);
    EXPECT_EQ(counts.trianglesDrawn, expectedCounts.trianglesDrawn) << what << ' ' << hwy::TargetName(target);
    EXPECT_EQ(counts.pixelsCovered, expectedCounts.pixelsCovered) << what << ' ' << hwy::TargetName(target);
    EXPECT_EQ(counts.pixelsShaded, expectedCounts.pixelsShaded) << what << ' ' << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

// Triangles of one size class around random places; `grid` > 0 puts corners on multiples of 1/grid pixel.
Soup triangles(std::uint32_t seed, int count, float extent, float size, float grid) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  const auto snap = [&](float v) { return grid > 0.0F ? std::floor(v * grid) / grid : v; };
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const float x = unit(random) * extent, y = unit(random) * extent,
                z = -1.0F - 400.0F * (1.0F + unit(random));
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 p{snap(x + unit(random) * size), snap(y + unit(random) * size), z + unit(random)};
      soup.indices.push_back(soup.vertex(p, {unit(random), unit(random), 1.0F}));
    }
  }
  return soup;
}

struct SizeClass {
  const char* name;
  int count;
  float size, grid;
};
constexpr SizeClass kClasses[] = {{"sub-pixel", 8000, 0.6F, 0.0F},
                                  {"micro", 4000, 2.0F, 0.0F},
                                  {"on pixel centres", 3000, 4.0F, 2.0F},
                                  {"small", 3000, 12.0F, 0.0F},
                                  {"on tile corners", 300, 200.0F, 1.0F / 64.0F},
                                  {"large", 100, 400.0F, 0.0F},
                                  {"far beyond the window", 60, 30000.0F, 0.0F}};

TEST(Kernels, AgreeOnTrianglesOfEverySize) {
  for (const SizeClass& c : kClasses)
    for (const int samples : {1, 4, 8}) {
      const Geometry geometry = triangles(11, c.count / samples, 150.0F, c.size, c.grid).geometry();
      Scene scene(pixelProjection(300, 170));
      scene.frame.samples = samples;
      scene.draws[0].geometry = &geometry;
      scene.materials[0].doubleSided = samples == 4;
      expectSameOnEveryTarget(scene, c.name);
    }
}

TEST(Kernels, AgreeOnAMillionTriangles) {
  const Geometry geometry = triangles(12, 1000000, 240.0F, 1.2F, 0.0F).geometry();
  Scene scene(pixelProjection(480, 300));
  scene.frame.samples = 1;
  scene.draws[0].geometry = &geometry;
  expectSameOnEveryTarget(scene, "a million triangles");
}

TEST(Kernels, AgreeOnSlivers) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Soup soup;
  for (int i = 0; i < 1500; ++i) {
    const glm::vec3 a{unit(random) * 150.0F, unit(random) * 80.0F, -100.0F};
    const glm::vec3 along{unit(random) * 300.0F, unit(random) * 300.0F, unit(random) * 50.0F};
    soup.triangle(a, a + along, a + along * 0.5F + glm::vec3{unit(random), unit(random), 0.0F} * 0.02F);
  }
  const Geometry geometry = soup.geometry();
  Scene scene(pixelProjection(300, 170));
  scene.draws[0].geometry = &geometry;
  scene.materials[0].doubleSided = true;
  expectSameOnEveryTarget(scene, "slivers");
}

TEST(Kernels, AgreeInPerspectiveFromTinyToHugeDistances) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Soup soup;
  for (int i = 0; i < 1500; ++i) {
    const float w = std::exp2(unit(random) * 20.0F);
    for (int k = 0; k < 3; ++k) {
      const float x = unit(random) * w, y = unit(random) * w, z = -w * (1.0F + unit(random) * 1.2F);
      soup.indices.push_back(soup.vertex({x, y, z}, {unit(random), unit(random), unit(random)}));
    }
  }
  const Geometry geometry = soup.geometry();
  Scene scene({true, 140.0F, 140.0F, 1e-6F, 1e6F, 281, 203});
  scene.draws[0].geometry = &geometry;
  scene.materials[0].doubleSided = true;
  scene.frame.samples = 1;
  expectSameOnEveryTarget(scene, "w from 1e-6 to 1e6");
}

// Every filter and wrap mode, magnified in front and minified far away, coordinates beyond the image on all sides.
TEST(Kernels, AgreeOnTextures) {
  constexpr int kWidth = 37, kHeight = 21;
  std::mt19937 random(7);
  std::vector<std::uint8_t> pixels(std::size_t{4} * kWidth * kHeight);
  for (std::uint8_t& byte : pixels) byte = static_cast<std::uint8_t>(random());
  const std::vector<glm::vec3> positions{{-6, -1, -1.2F}, {6, -1, -1.2F}, {60, 9, -60}, {-60, 9, -60}};
  const std::vector<glm::vec3> normals(4, glm::vec3(0.0F, 1.0F, 0.0F));
  const std::vector<glm::vec2> texcoords{{-1.7F, -0.3F}, {2.6F, 0.1F}, {9.0F, 31.0F}, {-8.0F, 29.0F}};
  const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  const Part part{0, 2, 0};
  Vertices vertices;
  vertices.positions = positions, vertices.normals = normals, vertices.texcoords = texcoords;
  const Geometry geometry(vertices, indices, std::span(&part, 1));
  for (const Filter filter : {Filter::kNearest, Filter::kLinear, Filter::kNearestMipNearest,
                              Filter::kLinearMipNearest, Filter::kNearestMipLinear, Filter::kLinearMipLinear})
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge})
      for (const bool magnified : {false, true}) {
        const Sampler sampler{wrap, Wrap::kMirroredRepeat, filter, magnified};
        const Texture texture(kWidth, kHeight, pixels, Texture::Content::kSrgb, sampler);
        Scene scene({true, 90.0F, 90.0F, 0.5F, 100.0F, 151, 90});
        scene.draws[0].geometry = &geometry;
        scene.materials[0].baseColorTexture = &texture;
        scene.materials[0].unlit = true;
        scene.materials[0].doubleSided = true;
        scene.frame.samples = magnified ? 1 : 4;
        expectSameOnEveryTarget(scene, "textures");
      }
}

// A floor towards the horizon and a wall, with texture coordinates, colours and some of everything.
class TexturedScene {
 public:
  TexturedScene(const Sampler& sampler, int size, AlphaMode alphaMode)
      : texture_(size, size + 3, pixels(size, size + 3), Texture::Content::kSrgb, sampler),
        scene(projection()) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    Soup soup;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec4> colors;
    for (int i = 0; i < 120; ++i) {
      const glm::vec3 center{unit(random) * 6.0F, unit(random) * 4.0F, -8.0F + unit(random) * 6.0F};
      for (int k = 0; k < 3; ++k) {
        const glm::vec3 p = center + glm::vec3{unit(random), unit(random), unit(random)} * 3.0F;
        soup.indices.push_back(soup.vertex(p, {unit(random), unit(random), 1.0F}));
        texcoords.emplace_back(p.x * 0.7F, p.y * 0.7F + p.z);
        colors.emplace_back(unit(random) * 0.5F + 0.5F, 0.7F, 0.9F, unit(random) * 0.5F + 0.5F);
      }
    }
    Vertices v;
    v.positions = soup.positions, v.normals = soup.normals, v.texcoords = texcoords, v.colors = colors;
    const Part part{0, static_cast<std::uint32_t>(soup.indices.size() / 3), 0};
    geometry_ = std::make_unique<Geometry>(v, soup.indices, std::span(&part, 1));
    scene.draws[0].geometry = geometry_.get();
    Material& m = scene.materials[0];
    m.baseColorTexture = &texture_;
    m.alphaMode = alphaMode;
    m.doubleSided = true;
    scene.lights.push_back(
        {.kind = Light::Kind::kPoint, .position = {1, 2, -3}, .range = 9, .color = {3, 2, 1}});
    scene.lights.push_back({.kind = Light::Kind::kSpot,
                            .position = {0, 3, -2},
                            .direction = {0, -0.6F, -0.8F},
                            .spotScale = 4,
                            .spotOffset = -3,
                            .color = {2, 2, 9}});
  }
  static Projection projection() { return {true, 120.0F, 120.0F, 0.5F, 50.0F, 211, 141}; }

 private:
  static std::vector<std::uint8_t> pixels(int w, int h) {
    std::mt19937 random(4);
    std::vector<std::uint8_t> p(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    for (auto& b : p) b = static_cast<std::uint8_t>(random() & 255U);
    return p;
  }
  Texture texture_;
  std::unique_ptr<Geometry> geometry_;

 public:
  Scene scene;
};

TEST(Kernels, AgreeOnTexturesOfEveryFilterAndWrap) {
  for (const Filter filter : {Filter::kNearest, Filter::kLinear, Filter::kNearestMipNearest,
                              Filter::kLinearMipNearest, Filter::kNearestMipLinear, Filter::kLinearMipLinear})
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge}) {
      TexturedScene textured({wrap, wrap, filter, filter != Filter::kLinear}, 37, AlphaMode::kOpaque);
      textured.scene.frame.samples = wrap == Wrap::kRepeat ? 4 : 1;
      expectSameOnEveryTarget(textured.scene, "texture");
    }
}

// Triangles from the eye to the far plane, of which rounding puts samples beyond it, and a light that tells.
TEST(Kernels, AgreeOnPointsThatRoundingPutsBeyondTheFarPlane) {
  constexpr float kFar = 1e5F;
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Soup soup;
  // Their upper edges, all but at the far plane, run through centres of pixels.
  const auto far = [&](int column, int row) {
    const float w = kFar * (0.99F + 0.0099F * unit(random));
    return glm::vec3(static_cast<float>(column - 140) / 140.0F * w,
                     static_cast<float>(101 - row) / 140.0F * w, -w);
  };
  for (int i = 0; i < 60; ++i) {
    constexpr float kNear = 0.0101F;
    soup.triangle({unit(random) * kNear, -0.7F * kNear, -kNear}, far(150 + i, i), far(130 - i, i));
  }
  const Geometry geometry = soup.geometry();
  for (const int samples : {1, 4}) {
    Scene scene({true, 140.0F, 140.0F, 0.01F, kFar, 281, 203});
    scene.frame.samples = samples;
    scene.draws[0].geometry = &geometry;
    scene.materials[0].doubleSided = true;
    scene.lights[0] = {.kind = Light::Kind::kPoint,
                       .position = {0.0F, 0.0F, -0.7F * kFar},
                       .color = glm::vec3(8e9F),
                       .ambient = 0.0F};
    Renderer renderer(1);
    const Picture picture = scene.draw(renderer);
    if (samples == 1) {  // with several, none of them lies there, but colours are those of the centres
      EXPECT_GT(std::count(picture.depth.begin(), picture.depth.end(), 1.0F / (1.0F / kFar)), 20);
    }
    expectSameOnEveryTarget(scene, "beyond the far plane");
  }
}

TEST(Kernels, AgreeOnTextureCoordinatesThatAreNoNumbers) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kStrange[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 1e30F,
                                -1e30F};
  Soup soup;
  std::vector<glm::vec2> texcoords;
  for (std::size_t i = 0; i < 40; ++i) {
    const glm::vec3 corner{static_cast<float>(i % 8) * 12.0F - 48.0F,
                           static_cast<float>(i / 8) * 12.0F - 30.0F, -5.0F - static_cast<float>(i)};
    soup.triangle(corner, corner + glm::vec3(12.0F, 0.0F, -0.5F), corner + glm::vec3(0.0F, 12.0F, -0.3F));
    texcoords.insert(texcoords.end(), {{0.1F, 0.2F}, {1.7F, 0.3F}, {0.2F, 2.4F}});
    texcoords[3 * i + i % 3][static_cast<int>(i / 5 % 2)] = kStrange[i % 5];
    if (i >= 20) texcoords[3 * i + (i + 1) % 3][static_cast<int>(i / 5 % 2)] = kStrange[i / 2 % 5];
  }
  Vertices vertices;
  vertices.positions = soup.positions, vertices.normals = soup.normals, vertices.texcoords = texcoords;
  const Part part{0, 40, 0};
  const Geometry geometry(vertices, soup.indices, std::span(&part, 1));
  for (const Filter filter : {Filter::kNearest, Filter::kLinearMipNearest, Filter::kLinearMipLinear})
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge})
      for (const int samples : {1, 4}) {
        std::vector<std::uint8_t> pixels(4UL * 9 * 5);
        for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 37);
        const Texture texture(9, 5, pixels, Texture::Content::kSrgb, {wrap, wrap, filter, true});
        Scene scene(pixelProjection(110, 70));
        scene.draws[0].geometry = &geometry;
        scene.materials[0].baseColorTexture = &texture;
        scene.frame.samples = samples;
        expectSameOnEveryTarget(scene, "coordinates that are no numbers");
      }
}

TEST(Kernels, AgreeOnMasksAndBlending) {
  for (const AlphaMode mode : {AlphaMode::kMask, AlphaMode::kBlend})
    for (const int samples : {1, 4}) {
      TexturedScene textured({}, 16, mode);
      textured.scene.frame.samples = samples;
      expectSameOnEveryTarget(textured.scene, mode == AlphaMode::kMask ? "mask" : "blend");
    }
}

}  // namespace
}  // namespace limn::raster::test
