// What is interpolated at a vector of points, and the colour that follows from it. Definition: surface.cpp.
#if defined(LIMN_RASTER_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_POINTS_INL_H_
#undef LIMN_RASTER_POINTS_INL_H_
#else
#define LIMN_RASTER_POINTS_INL_H_
#endif

#include "raster/lighting-inl.h"
#include "raster/surface.h"
#include "raster/texel-inl.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// All that a material without normal map and emissive texture needs.
struct Inputs {
  Points points;
  Color color;  ///< of the vertices
  FootprintVector footprint;
};

/// Left to the definition.
HWY_INLINE bool isComplex(const Material& m) {
  return m.normalTexture != nullptr || m.emissiveTexture != nullptr;
}

/// Linear colours of points that have one material.
HWY_INLINE Color shadePoints(const Inputs& in, const Material& m, const Lighting& lighting) {
  const F f;
  const glm::vec4& c = m.baseColor;
  Color base{hn::Mul(hn::Set(f, c.x), in.color.r), hn::Mul(hn::Set(f, c.y), in.color.g),
             hn::Mul(hn::Set(f, c.z), in.color.b)};
  if (m.baseColorTexture != nullptr) {
    const Color texel = sampleVector(m.baseColorTexture->data(), in.footprint);
    base = {hn::Mul(base.r, texel.r), hn::Mul(base.g, texel.g), hn::Mul(base.b, texel.b)};
  }
  return m.unlit ? base : lighting(in.points, base, m);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
