// Sampling against its definition by OpenGL, evaluated in double precision on the image itself.
#include "raster/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "raster/texel.h"

namespace limn::raster::test {
namespace {

struct Size {
  int width, height;
};

// Texel of level 0 outside of the image, by OpenGL 4.6, table 8.20.
int wrappedTexel(int i, int size, Wrap wrap) {
  if (wrap == Wrap::kRepeat) return ((i % size) + size) % size;
  if (wrap == Wrap::kClampToEdge) return std::min(std::max(i, 0), size - 1);
  const int period = ((i % (2 * size)) + 2 * size) % (2 * size);
  return period < size ? period : 2 * size - 1 - period;
}

class Oracle {
 public:
  Oracle(Size size, const Sampler& sampler, std::uint32_t seed) : size_(size), sampler_(sampler) {
    std::mt19937 random(seed);
    pixels_.resize(4 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    for (std::uint8_t& byte : pixels_) byte = static_cast<std::uint8_t>(random());
  }

  Texture texture() const {
    return {size_.width, size_.height, pixels_, Texture::Content::kLinear, sampler_};
  }

  glm::dvec4 sample(double u, double v, bool linear) const {
    const double x = u * size_.width - (linear ? 0.5 : 0.0), y = v * size_.height - (linear ? 0.5 : 0.0);
    const double fx = std::floor(x), fy = std::floor(y);
    const auto i = static_cast<int>(fx), j = static_cast<int>(fy);
    if (!linear) return texel(i, j);
    const double a = x - fx, b = y - fy;
    return (texel(i, j) * (1 - a) + texel(i + 1, j) * a) * (1 - b) +
           (texel(i, j + 1) * (1 - a) + texel(i + 1, j + 1) * a) * b;
  }

 private:
  glm::dvec4 texel(int i, int j) const {
    const auto x = static_cast<std::size_t>(wrappedTexel(i, size_.width, sampler_.wrapU));
    const auto y = static_cast<std::size_t>(wrappedTexel(j, size_.height, sampler_.wrapV));
    const std::uint8_t* p = &pixels_[4 * (y * static_cast<std::size_t>(size_.width) + x)];
    return glm::dvec4(p[0], p[1], p[2], p[3]) / 255.0;
  }

  Size size_;
  Sampler sampler_;
  std::vector<std::uint8_t> pixels_;
};

TEST(TextureSampling, IsWhatOpenGlSaysForEveryWrapModeAndSize) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> coordinate(-2.5F, 3.5F);
  std::uint32_t seed = 1;
  for (const Size size : {Size{1, 1}, Size{2, 1}, Size{1, 5}, Size{7, 3}, Size{16, 16}, Size{33, 40}})
    for (const Wrap wrapU : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge})
      for (const Wrap wrapV : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge})
        for (const bool linear : {false, true}) {
          const Oracle oracle(size, {wrapU, wrapV, Filter::kLinear, linear}, seed++);
          const Texture texture = oracle.texture();
          for (int i = 0; i < 60; ++i) {
            const float u = coordinate(random), v = coordinate(random);
            if (!linear) {  // near a texel's border either neighbour is right
              const double x = double{u} * size.width, y = double{v} * size.height;
              if (std::abs(x - std::round(x)) < 1e-4 || std::abs(y - std::round(y)) < 1e-4) continue;
            }
            const glm::vec4 is = sample(texture.data(), {u, v, 0, 0, 0, 0});
            const glm::dvec4 should = oracle.sample(u, v, linear);
            for (int c = 0; c < 4; ++c)
              ASSERT_NEAR(is[c], should[c], 6e-5)
                  << size.width << 'x' << size.height << " at " << u << ", " << v << " wrap "
                  << static_cast<int>(wrapU) << ' ' << static_cast<int>(wrapV);
          }
        }
}

TEST(TextureSampling, HasATexelForEveryNumber) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInfinity = std::numeric_limits<float>::infinity();
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge})
    for (const Filter filter :
         {Filter::kNearest, Filter::kLinear, Filter::kLinearMipNearest, Filter::kLinearMipLinear}) {
      const Texture texture = Oracle({7, 3}, {wrap, wrap, filter, true}, 8).texture();
      const auto at = [&](float u, float v) { return sample(texture.data(), {u, v, 0, 0, 0, 0}); };
      const auto wide = [&](float ux, float vy) {
        return sample(texture.data(), {0.3F, 0.4F, ux, 0, 0, vy});
      };
      for (const float low : {kNan, -kInfinity, -1e30F}) {
        EXPECT_EQ(at(low, 0.4F), at(-1e6F, 0.4F)) << low;
        EXPECT_EQ(at(0.3F, low), at(0.3F, -1e6F)) << low;
      }
      for (const float high : {kInfinity, 1e30F}) {
        EXPECT_EQ(at(high, 0.4F), at(1e6F, 0.4F)) << high;
        EXPECT_EQ(at(0.3F, high), at(0.3F, 1e6F)) << high;
      }
      // Of footprints: none is known, or the widest.
      EXPECT_EQ(wide(kNan, kNan), at(0.3F, 0.4F));
      EXPECT_EQ(wide(kInfinity, 0.0F), wide(1e14F, 0.0F));
      EXPECT_EQ(wide(0.0F, kInfinity), wide(0.0F, 1e14F));
    }
}

TEST(TextureSampling, EveryLevelHasTheMeanOfTheImage) {
  for (const Size size : {Size{64, 64}, Size{37, 21}, Size{5, 128}}) {
    const Oracle oracle(size, {}, 3);
    const Texture texture = oracle.texture();
    const Texture::Data& t = texture.data();
    glm::dvec4 first(0.0);
    for (std::size_t level = 0; level < t.levels.size(); ++level) {
      const TextureLevel& l = t.levels[level];
      glm::dvec4 sum(0.0);
      for (int y = 0; y < l.height; ++y)
        for (int x = 0; x < l.width; ++x)
          for (int c = 0; c < 4; ++c) sum[c] += t.at(l, x, y)[c] / 65535.0;
      sum /= l.width * l.height;
      if (level == 0) first = sum;
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(sum[c], first[c], 1e-4) << level;
    }
    EXPECT_EQ(t.levels.back().width * t.levels.back().height, 1);
  }
}

TEST(TextureSampling, LooksUpItsLevelsInTables) {
  const Texture texture = Oracle({300, 77}, {}, 5).texture();
  const Texture::Data& t = texture.data();
  ASSERT_LE(t.levels.size(), kMaxLevels);
  for (std::size_t i = 0; i < t.levels.size(); ++i) {
    EXPECT_EQ(t.tables.width[i], static_cast<float>(t.levels[i].width));
    EXPECT_EQ(t.tables.height[i], static_cast<float>(t.levels[i].height));
    EXPECT_EQ(t.tables.lastColumn[i], t.levels[i].width - 1);
    EXPECT_EQ(t.tables.lastRow[i], t.levels[i].height - 1);
    EXPECT_EQ(t.tables.stride[i], t.levels[i].stride());
    EXPECT_EQ(t.tables.origin[i], t.levels[i].texel(0, 0));
  }
  EXPECT_EQ(t.texels.size(),
            4 * static_cast<std::size_t>(t.levels.back().first + t.levels.back().texelCount()));
}

}  // namespace
}  // namespace limn::raster::test
