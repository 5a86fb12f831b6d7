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

/// fastLog2() and levelOf() of texel.h.
HWY_INLINE VF levelOfVector(const Texture::Data& t, const FootprintVector& p) {
  const I d;
  const F f;
  const VF w = hn::Set(f, static_cast<float>(t.levels[0].width));
  const VF h = hn::Set(f, static_cast<float>(t.levels[0].height));
  const VF ax = hn::Mul(p.ux, w), bx = hn::Mul(p.vx, h), ay = hn::Mul(p.uy, w), by = hn::Mul(p.vy, h);
  const VF dx = hn::Add(hn::Mul(ax, ax), hn::Mul(bx, bx)), dy = hn::Add(hn::Mul(ay, ay), hn::Mul(by, by));
  const VF square = hn::Min(hn::Max(hn::Max(dx, dy), hn::Set(f, 1e-30F)), hn::Set(f, 1e30F));
  const VI bits = hn::BitCast(d, square);
  const VF exponent = hn::ConvertTo(f, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(d, 127)));
  const VI fraction = hn::Or(hn::And(bits, hn::Set(d, 0x7fffff)), hn::Set(d, 0x3f800000));
  const VF m = hn::Sub(hn::BitCast(f, fraction), hn::Set(f, 1.0F));
  const VF parabola = hn::Mul(m, hn::Sub(hn::Set(f, 1.3465557F), hn::Mul(hn::Set(f, 0.3465557F), m)));
  return hn::Mul(hn::Set(f, 0.5F), hn::Add(exponent, parabola));
}

/// wrapped() of texel.h.
HWY_INLINE VF wrappedVector(VF u, Wrap wrap) {
  const F f;
  const VF zero = hn::Zero(f), one = hn::Set(f, 1.0F), two = hn::Set(f, 2.0F);
  u = hn::Min(hn::Max(u, hn::Set(f, -1e6F)), hn::Set(f, 1e6F));
  if (wrap == Wrap::kClampToEdge) return hn::Min(hn::Max(u, zero), one);
  if (wrap == Wrap::kRepeat) return hn::Sub(u, hn::Floor(u));
  const VF half = hn::Mul(u, hn::Set(f, 0.5F)), period = hn::Mul(hn::Sub(half, hn::Floor(half)), two);
  return hn::IfThenElse(hn::Gt(period, one), hn::Sub(two, period), period);
}

struct TapsVector {
  VI first, second;
  VF share;
};

/// linearTaps() and nearestTap() of texel.h. Whatever a lane holds, its taps are within the level.
HWY_INLINE TapsVector tapsOf(VF wrappedU, std::int32_t size, Wrap wrap, bool linear) {
  const I d;
  const F f;
  const VI zero = hn::Zero(d), last = hn::Set(d, size - 1);
  const VF scaled = hn::Mul(wrappedU, hn::Set(f, static_cast<float>(size)));
  const auto within = [&](VI i) { return hn::Min(hn::Max(i, zero), last); };
  if (!linear) {
    const VI i = within(hn::ConvertTo(d, scaled));
    return {i, i, hn::Zero(f)};
  }
  const VF x = hn::Sub(scaled, hn::Set(f, 0.5F)), base = hn::Floor(x);
  const VI i = hn::ConvertTo(d, base), next = hn::Add(i, hn::Set(d, 1));
  const bool around = wrap == Wrap::kRepeat;
  const VI first = hn::IfThenElse(hn::Lt(i, zero), around ? last : zero, i);
  const VI second = hn::IfThenElse(hn::Gt(next, last), around ? zero : last, next);
  return {within(first), within(second), hn::Sub(x, base)};
}

/// Texels, from memory in a loop: that is faster than gathers.
HWY_INLINE Color fetch(const Texture::Data& t, VI texel) {
  const I d;
  const F f;
  alignas(64) std::int32_t index[kLanes], redGreen[kLanes], blue[kLanes];
  hn::Store(texel, d, index);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::uint16_t* rgba = &t.texels[4 * static_cast<std::size_t>(index[i])];
    redGreen[i] = static_cast<std::int32_t>(rgba[0] | static_cast<std::uint32_t>(rgba[1]) << 16U);
    blue[i] = rgba[2];
  }
  const VI two = hn::Load(d, redGreen), low = hn::Set(d, 0xffff);
  return {hn::ConvertTo(f, hn::And(two, low)), hn::ConvertTo(f, hn::And(hn::ShiftRight<16>(two), low)),
          hn::ConvertTo(f, hn::Load(d, blue))};
}

/// sampleLevel() of texel.h.
HWY_INLINE Color sampleLevelVector(const Texture::Data& t, VF u, VF v, std::int32_t level, bool linear) {
  const I d;
  const F f;
  const TextureLevel& l = t.levels[static_cast<std::size_t>(level)];
  const TapsVector x = tapsOf(wrappedVector(u, t.sampler.wrapU), l.width, t.sampler.wrapU, linear);
  const TapsVector y = tapsOf(wrappedVector(v, t.sampler.wrapV), l.height, t.sampler.wrapV, linear);
  const VI origin = hn::Set(d, static_cast<std::int32_t>(l.first)), width = hn::Set(d, l.width);
  const VI upperRow = hn::Add(origin, hn::Mul(y.first, width));
  const VI lowerRow = hn::Add(origin, hn::Mul(y.second, width));
  const Color a = fetch(t, hn::Add(upperRow, x.first)), b = fetch(t, hn::Add(upperRow, x.second));
  const Color c = fetch(t, hn::Add(lowerRow, x.first)), e = fetch(t, hn::Add(lowerRow, x.second));
  const auto mixed = [&](VF from, VF to, VF share) {
    return hn::Add(from, hn::Mul(hn::Sub(to, from), share));
  };
  const auto channel = [&](VF fa, VF fb, VF fc, VF fe) {
    const VF upper = mixed(fa, fb, x.share), lower = mixed(fc, fe, x.share);
    return hn::Mul(mixed(upper, lower, y.share), hn::Set(f, 1.0F / 65535.0F));
  };
  return {channel(a.r, b.r, c.r, e.r), channel(a.g, b.g, c.g, e.g), channel(a.b, b.b, c.b, e.b)};
}

/// The lanes of `wanted`, each from its own level: mostly one or two are at hand.
HWY_INLINE void sampleLevels(const Texture::Data& t, const FootprintVector& p, VI levels, bool linear,
                             MI wanted, Color& color) {
  const I d;
  alignas(64) std::int32_t level[kLanes];
  hn::Store(levels, d, level);
  while (!hn::AllFalse(d, wanted)) {
    const std::int32_t one = level[static_cast<std::size_t>(hn::FindFirstTrue(d, wanted))];
    const MI same = hn::And(wanted, hn::Eq(levels, hn::Set(d, one)));
    wanted = hn::AndNot(same, wanted);
    const Color c = sampleLevelVector(t, p.u, p.v, one, linear);
    const MF where = hn::RebindMask(F(), same);
    color.r = hn::IfThenElse(where, c.r, color.r);
    color.g = hn::IfThenElse(where, c.g, color.g);
    color.b = hn::IfThenElse(where, c.b, color.b);
  }
}

/// sample() of texel.h.
HWY_INLINE Color sampleVector(const Texture::Data& t, const FootprintVector& p) {
  const I d;
  const F f;
  const VF lambda = levelOfVector(t, p), zero = hn::Zero(f);
  const VI last = hn::Set(d, static_cast<std::int32_t>(t.levels.size()) - 1);
  const MI smaller = hn::RebindMask(d, hn::Gt(lambda, zero));
  const Filter filter = t.sampler.minification;
  const bool nearestMip = filter == Filter::kNearestMipNearest || filter == Filter::kLinearMipNearest;
  const bool oneLevel = filter == Filter::kNearest || filter == Filter::kLinear;
  const bool linear =
      filter == Filter::kLinear || filter == Filter::kLinearMipNearest || filter == Filter::kLinearMipLinear;

  const VF rounded = nearestMip ? hn::Add(lambda, hn::Set(f, 0.5F)) : lambda;
  const VI chosen = oneLevel ? hn::Zero(d) : hn::Min(hn::ConvertTo(d, rounded), last);
  const VI level = hn::IfThenElseZero(smaller, hn::Max(chosen, hn::Zero(d)));
  Color color{zero, zero, zero};
  if (linear == t.sampler.linearMagnification) {
    sampleLevels(t, p, level, linear, hn::FirstN(d, kLanes), color);
  } else {
    sampleLevels(t, p, level, linear, smaller, color);
    sampleLevels(t, p, level, !linear, hn::Not(smaller), color);
  }
  if (oneLevel || nearestMip) return color;
  const MI between = hn::And(smaller, hn::Lt(level, last));
  if (hn::AllFalse(d, between)) return color;
  Color coarse = color;
  sampleLevels(t, p, hn::Add(level, hn::Set(d, 1)), linear, between, coarse);
  const VF share = hn::Sub(lambda, hn::ConvertTo(f, level));
  const MF where = hn::RebindMask(f, between);
  const auto mix = [&](VF& fine, VF other) {
    fine = hn::IfThenElse(where, hn::Add(fine, hn::Mul(hn::Sub(other, fine), share)), fine);
  };
  mix(color.r, coarse.r);
  mix(color.g, coarse.g);
  mix(color.b, coarse.b);
  return color;
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
