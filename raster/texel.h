// A texture as the shading kernels read it, and the definition of sampling it.
//
// Based on: OpenGL 4.6 specification, section 8.14 (texture minification); L. Williams, "Pyramidal
// parametrics", 1983. Differs in: lambda's logarithm is read off the float's exponent plus a parabola over
// its mantissa (exact at powers of two, within 0.01 between them), as hardware does.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "raster/texture.h"

namespace limn::raster {

/// One mip level within Texture::Data::texels.
struct TextureLevel {
  std::int32_t width, height;
  std::size_t first;  ///< texel; below 2^29
};

struct Texture::Data {
  Sampler sampler;
  std::vector<TextureLevel> levels;
  std::vector<std::uint16_t> texels;  ///< RGBA, linear light, 65535 = 1
  bool transparent = false;
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
  return 0.5F * fastLog2(std::min(std::max(std::max(dx, dy), 1e-30F), 1e30F));
}

/// A coordinate within [0, 1] from any finite one.
inline float wrapped(float u, Wrap wrap) {
  u = std::min(std::max(u, -1e6F), 1e6F);
  if (wrap == Wrap::kClampToEdge) return std::min(std::max(u, 0.0F), 1.0F);
  if (wrap == Wrap::kRepeat) return u - std::floor(u);
  const float half = u * 0.5F, period = (half - std::floor(half)) * 2.0F;
  return period > 1.0F ? 2.0F - period : period;
}

/// The texel before and after a coordinate, and how far between them it lies.
struct Taps {
  std::int32_t first, second;
  float share;
};

inline Taps linearTaps(float wrappedU, std::int32_t size, Wrap wrap) {
  const float x = wrappedU * static_cast<float>(size) - 0.5F, base = std::floor(x);
  const auto i = static_cast<std::int32_t>(base);
  const bool around = wrap == Wrap::kRepeat;
  const std::int32_t first = i < 0 ? (around ? size - 1 : 0) : i;
  const std::int32_t second = i + 1 >= size ? (around ? 0 : size - 1) : i + 1;
  return {std::min(first, size - 1), second, x - base};
}

inline Taps nearestTap(float wrappedU, std::int32_t size) {
  const auto i = std::min(static_cast<std::int32_t>(wrappedU * static_cast<float>(size)), size - 1);
  return {i, i, 0.0F};
}

/// One level: ((a + (b - a)·x) and the row below, then between the rows.
inline glm::vec4 sampleLevel(const Texture::Data& t, float u, float v, std::int32_t level, bool linear) {
  const TextureLevel& l = t.levels[static_cast<std::size_t>(level)];
  const float wu = wrapped(u, t.sampler.wrapU), wv = wrapped(v, t.sampler.wrapV);
  const Taps x = linear ? linearTaps(wu, l.width, t.sampler.wrapU) : nearestTap(wu, l.width);
  const Taps y = linear ? linearTaps(wv, l.height, t.sampler.wrapV) : nearestTap(wv, l.height);
  const auto texel = [&](std::int32_t i, std::int32_t j) {
    return &t.texels[4 * (l.first + static_cast<std::size_t>(j) * static_cast<std::size_t>(l.width) +
                          static_cast<std::size_t>(i))];
  };
  const std::uint16_t *a = texel(x.first, y.first), *b = texel(x.second, y.first);
  const std::uint16_t *c = texel(x.first, y.second), *d = texel(x.second, y.second);
  glm::vec4 result;
  for (int i = 0; i < 4; ++i) {
    const auto fa = static_cast<float>(a[i]), fb = static_cast<float>(b[i]);
    const auto fc = static_cast<float>(c[i]), fd = static_cast<float>(d[i]);
    const float upper = fa + (fb - fa) * x.share, lower = fc + (fd - fc) * x.share;
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
