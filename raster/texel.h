// A texture as the shading kernels read it, and the definition of sampling it.
//
// Based on: OpenGL 4.6 specification, section 8.14 (texture minification); L. Williams, "Pyramidal
// parametrics", 1983. Differs in: lambda's logarithm is read off the float's exponent plus a parabola over
// its mantissa (exact at powers of two, within 0.01 between them), as hardware does.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "raster/numbers.h"
#include "raster/texture.h"

namespace limn::raster {

/// One mip level. It has a border one texel wide that holds what wrapping finds there, so that whatever lies within the
/// level, the four texels around it lie side by side.
struct TextureLevel {
  std::int32_t width, height;  ///< without the border
  std::int32_t first;          ///< of the border's upper left texel in Texture::Data::texels; below 2^29

  std::int32_t stride() const { return width + 2; }
  std::int32_t texelCount() const { return stride() * (height + 2); }
  /// Of the texel in a column from -1 to width and a row from -1 to height.
  std::int32_t texel(std::int32_t column, std::int32_t row) const {
    return first + (row + 1) * stride() + (column + 1);
  }
};

inline constexpr std::size_t kMaxLevels = 16;

/// Numbers of all levels side by side, for kernels that look them up.
struct LevelTables {
  alignas(64) std::array<float, kMaxLevels> width{}, height{};
  alignas(64) std::array<std::int32_t, kMaxLevels> lastColumn{}, lastRow{}, stride{},
      origin{};  ///< texel (0, 0)
};

struct Texture::Data {
  Sampler sampler;
  std::vector<TextureLevel> levels;
  LevelTables tables;
  std::vector<std::uint16_t> texels;  ///< RGBA, linear light, 65535 = 1
  bool transparent = false;

  /// The four channels of a texel; column and row as in TextureLevel::texel().
  const std::uint16_t* at(const TextureLevel& level, std::int32_t column, std::int32_t row) const {
    return &texels[4 * static_cast<std::size_t>(level.texel(column, row))];
  }
  std::uint16_t* at(const TextureLevel& level, std::int32_t column, std::int32_t row) {
    return &texels[4 * static_cast<std::size_t>(level.texel(column, row))];
  }
};

/// log2 of a positive normal float.
inline float fastLog2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 127);
  const float f = std::bit_cast<float>((bits & 0x7fffffU) | 0x3f800000U) - 1.0F;
  return exponent + f * (1.3465557F - 0.3465557F * f);
}

/// Texture coordinates at a pixel and their change from pixel to pixel.
struct Footprint {
  float u, v, ux, vx, uy, vy;
};

/// Level of detail: 0 and below magnify.
inline float levelOf(const Texture::Data& t, const Footprint& p) {
  const auto w = static_cast<float>(t.levels[0].width), h = static_cast<float>(t.levels[0].height);
  const float ax = p.ux * w, bx = p.vx * h, ay = p.uy * w, by = p.vy * h;
  const float dx = ax * ax + bx * bx, dy = ay * ay + by * by;
  return 0.5F * fastLog2(std::min(larger(larger(dx, dy), 1e-30F), 1e30F));
}

/// A coordinate within [0, 1] from any number.
inline float wrapped(float u, Wrap wrap) {
  u = std::min(larger(u, -1e6F), 1e6F);
  if (wrap == Wrap::kClampToEdge) return std::min(std::max(u, 0.0F), 1.0F);
  if (wrap == Wrap::kRepeat) return u - std::floor(u);
  const float half = u * 0.5F, period = (half - std::floor(half)) * 2.0F;
  return period > 1.0F ? 2.0F - period : period;
}

/// The texel before a coordinate, and how far from it towards the next one it lies.
struct Tap {
  std::int32_t texel;  ///< -1 … size - 1
  float share;
};

inline Tap tapOf(float wrappedU, std::int32_t size, bool linear) {
  const float scaled = wrappedU * static_cast<float>(size), x = linear ? scaled - 0.5F : scaled;
  const float base = std::floor(x);
  return {std::min(static_cast<std::int32_t>(base), size - 1), linear ? x - base : 0.0F};
}

/// One level: (a + (b - a)·x) and the row below, then between the rows.
inline glm::vec4 sampleLevel(const Texture::Data& t, float u, float v, std::int32_t level, bool linear) {
  const TextureLevel& l = t.levels[static_cast<std::size_t>(level)];
  const Tap x = tapOf(wrapped(u, t.sampler.wrapU), l.width, linear);
  const Tap y = tapOf(wrapped(v, t.sampler.wrapV), l.height, linear);
  const std::uint16_t *upperRow = t.at(l, x.texel, y.texel), *lowerRow = t.at(l, x.texel, y.texel + 1);
  glm::vec4 result;
  for (int i = 0; i < 4; ++i) {
    const auto a = static_cast<float>(upperRow[i]), b = static_cast<float>(upperRow[4 + i]);
    const auto c = static_cast<float>(lowerRow[i]), d = static_cast<float>(lowerRow[4 + i]);
    const float upper = a + (b - a) * x.share, lower = c + (d - c) * x.share;
    result[i] = (upper + (lower - upper) * y.share) * (1.0F / 65535.0F);
  }
  return result;
}

/// The texture's colour over a pixel.
inline glm::vec4 sample(const Texture::Data& t, const Footprint& p) {
  const float lambda = levelOf(t, p);
  const auto last = static_cast<std::int32_t>(t.levels.size()) - 1;
  const Filter filter = t.sampler.minification;
  if (!(lambda > 0.0F)) return sampleLevel(t, p.u, p.v, 0, t.sampler.linearMagnification);
  switch (filter) {
    case Filter::kNearest:
    case Filter::kLinear:
      return sampleLevel(t, p.u, p.v, 0, filter == Filter::kLinear);
    case Filter::kNearestMipNearest:
    case Filter::kLinearMipNearest:
      return sampleLevel(t, p.u, p.v, std::min(static_cast<std::int32_t>(lambda + 0.5F), last),
                         filter == Filter::kLinearMipNearest);
    default:
      break;
  }
  const bool linear = filter == Filter::kLinearMipLinear;
  const auto level = std::min(static_cast<std::int32_t>(lambda), last);
  const glm::vec4 fine = sampleLevel(t, p.u, p.v, level, linear);
  if (level == last) return fine;
  const float share = lambda - static_cast<float>(level);
  const glm::vec4 coarse = sampleLevel(t, p.u, p.v, level + 1, linear);
  return {fine.x + (coarse.x - fine.x) * share, fine.y + (coarse.y - fine.y) * share,
          fine.z + (coarse.z - fine.z) * share, fine.w + (coarse.w - fine.w) * share};
}

}  // namespace limn::raster
