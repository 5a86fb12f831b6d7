// Points to be shaded, a few vectors of them at a time, and the colours that follow. Definition: surface.cpp, lighting.h.
#if defined(LIMN_RASTER_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_POINTS_INL_H_
#undef LIMN_RASTER_POINTS_INL_H_
#else
#define LIMN_RASTER_POINTS_INL_H_
#endif

#include <algorithm>
#include <bit>

#include "raster/lighting-inl.h"
#include "raster/surface.h"
#include "raster/texel-inl.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// Left to the definition.
HWY_INLINE bool isComplex(const Material& m) {
  return m.normalTexture != nullptr || m.emissiveTexture != nullptr;
}

/// Writes the lanes of a mask to the target; to the others others may write at the same time.
HWY_INLINE void storePixels(VI color, MI lanes, std::uint8_t* to) {
  const I d;
  if constexpr (HWY_TARGET <= HWY_AVX2) {
    hn::BlendedStore(color, lanes, d, reinterpret_cast<std::int32_t*>(to));
  } else {
    alignas(64) std::int32_t pixels[kLanes];
    hn::Store(color, d, pixels);
    for (unsigned left = bitsOf(lanes); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      std::copy_n(reinterpret_cast<const std::uint8_t*>(pixels + lane), 4, to + 4 * lane);
    }
  }
}

/// Linear colours of points that have one material, `points.base` being what vertex colours and textures make of it.
template <bool kSole>
inline void lightPoints(PointBatch& points, const Material& m, const Lighting& lighting) {
  const F f;
  for (std::size_t i = 0; i < points.count; i += kLanes) {
    const Color base{hn::Load(f, points.base[0] + i), hn::Load(f, points.base[1] + i),
                     hn::Load(f, points.base[2] + i)};
    const Color color = m.unlit ? base : lighting.litColor<kSole>(points.point(i), m, base);
    hn::Store(color.r, f, points.color[0] + i);
    hn::Store(color.g, f, points.color[1] + i);
    hn::Store(color.b, f, points.color[2] + i);
  }
}
inline void shadePoints(PointBatch& points, const Material& m, const Lighting& lighting) {
  if (lighting.isSole(m) && !m.unlit)
    lightPoints<true>(points, m, lighting);
  else
    lightPoints<false>(points, m, lighting);
}

/// Points' base colours: the material's, times vertex colours.
HWY_INLINE void setBase(const Material& m, const Color& vertex, PointBatch& points, std::size_t i) {
  const F f;
  hn::Store(hn::Mul(hn::Set(f, m.baseColor.x), vertex.r), f, points.base[0] + i);
  hn::Store(hn::Mul(hn::Set(f, m.baseColor.y), vertex.g), f, points.base[1] + i);
  hn::Store(hn::Mul(hn::Set(f, m.baseColor.z), vertex.b), f, points.base[2] + i);
}

/// Base colours of all points: the material's, or with vertex colours those in `points`, times texels.
template <bool kColored>
HWY_INLINE void addTexels(const Material& m, TextureBatch& batch, PointBatch& points) {
  const F f;
  const TextureSampler sample(m.baseColorTexture->data(), batch);
  sample(points.count, [&](std::size_t i, const Color& texel) HWY_ATTR {
    const VF channels[3] = {texel.r, texel.g, texel.b};
    for (int k = 0; k < 3; ++k) {
      const VF base = kColored ? hn::Load(f, points.base[k] + i) : hn::Set(f, m.baseColor[k]);
      hn::Store(hn::Mul(base, channels[k]), f, points.base[k] + i);
    }
  });
}

/// Fills a batch's base colours with a material's that has neither vertex colours nor a texture.
inline void setPlainBase(const Material& m, PointBatch& points) {
  const VF one = hn::Set(F(), 1.0F);
  for (std::size_t i = 0; i < points.count; i += kLanes) setBase(m, {one, one, one}, points, i);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
