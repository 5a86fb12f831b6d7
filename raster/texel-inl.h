// Sampling a texture at a vector of pixels. Definition: texel.h.
#if defined(LIMN_RASTER_TEXEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_TEXEL_INL_H_
#undef LIMN_RASTER_TEXEL_INL_H_
#else
#define LIMN_RASTER_TEXEL_INL_H_
#endif

#include "raster/lighting-inl.h"
#include "raster/texel.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
struct FootprintVector {
  VF u, v, ux, vx, uy, vy;
};

HWY_INLINE Color sampleVector(const Texture::Data& t, const FootprintVector& p) {
  const F f;
  alignas(64) float in[6][kLanes], out[3][kLanes];
  hn::Store(p.u, f, in[0]), hn::Store(p.v, f, in[1]), hn::Store(p.ux, f, in[2]);
  hn::Store(p.vx, f, in[3]), hn::Store(p.uy, f, in[4]), hn::Store(p.vy, f, in[5]);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const glm::vec4 c = sample(t, {in[0][i], in[1][i], in[2][i], in[3][i], in[4][i], in[5][i]});
    out[0][i] = c.x, out[1][i] = c.y, out[2][i] = c.z;
  }
  return {hn::Load(f, out[0]), hn::Load(f, out[1]), hn::Load(f, out[2])};
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
