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

/// A table's number for each lane's level.
template <class D>
HWY_INLINE hn::Vec<D> lookUp(D d, const std::array<hn::TFromD<D>, kMaxLevels>& table, VI level) {
  if constexpr (kLanes == kMaxLevels)
    return hn::TableLookupLanes(hn::Load(d, table.data()), hn::IndicesFromVec(d, level));
  else
    return hn::GatherIndex(d, table.data(), level);
}

struct TapVector {
  VI texel;
  VF share;
};

/// tapOf() of texel.h. Whatever a lane holds, its texel is within the level and its border.
HWY_INLINE TapVector tapsOf(VF wrappedU, VF size, VI last, MF linear) {
  const I d;
  const F f;
  const VF scaled = hn::Mul(wrappedU, size);
  const VF x = hn::IfThenElse(linear, hn::Sub(scaled, hn::Set(f, 0.5F)), scaled), base = hn::Floor(x);
  const VI texel = hn::Min(hn::Max(hn::ConvertTo(d, base), hn::Set(d, -1)), last);
  return {texel, hn::IfThenElseZero(linear, hn::Sub(x, base))};
}

/// A texel and its right neighbour for each lane, two channels of 16 bits in each number.
struct TexelPairs {
  VI redGreen, blueAlpha, nextRedGreen, nextBlueAlpha;
};

/// The texel and its right neighbour of the lanes 0, 4, 8 … side by side.
template <class D>
HWY_INLINE hn::Vec<D> loadEveryFourth(D d, const std::uint16_t* texels, const std::int32_t* at) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, reinterpret_cast<const std::int32_t*>(texels + 4 * static_cast<std::ptrdiff_t>(*at)));
  } else {
    const hn::Half<D> half;
    const std::int32_t* upper = at + hn::MaxLanes(half);
    return hn::Combine(d, loadEveryFourth(half, texels, upper), loadEveryFourth(half, texels, at));
  }
}

/// One load of 128 bits for each lane; four lanes at a time are turned into numbers of their own.
HWY_INLINE TexelPairs fetchPairs(const std::uint16_t* texels, const std::int32_t* at) {
  const I d;
  const VI r0 = loadEveryFourth(d, texels, at), r1 = loadEveryFourth(d, texels, at + 1);
  const VI r2 = loadEveryFourth(d, texels, at + 2), r3 = loadEveryFourth(d, texels, at + 3);
  const VI low02 = hn::InterleaveLower(d, r0, r2), low13 = hn::InterleaveLower(d, r1, r3);
  const VI high02 = hn::InterleaveUpper(d, r0, r2), high13 = hn::InterleaveUpper(d, r1, r3);
  return {hn::InterleaveLower(d, low02, low13), hn::InterleaveUpper(d, low02, low13),
          hn::InterleaveLower(d, high02, high13), hn::InterleaveUpper(d, high02, high13)};
}

/// Between a texel and the next, of one row.
HWY_INLINE Color alongRow(const TexelPairs& p, VF share) {
  const I d;
  const F f;
  const VI mask = hn::Set(d, 0xffff);
  const auto low = [&](VI two) { return hn::ConvertTo(f, hn::And(two, mask)); };
  const auto high = [&](VI two) { return hn::ConvertTo(f, hn::And(hn::ShiftRight<16>(two), mask)); };
  const auto mixed = [&](VF from, VF to) { return hn::Add(from, hn::Mul(hn::Sub(to, from), share)); };
  return {mixed(low(p.redGreen), low(p.nextRedGreen)), mixed(high(p.redGreen), high(p.nextRedGreen)),
          mixed(low(p.blueAlpha), low(p.nextBlueAlpha))};
}

/// sampleLevel() of texel.h, each lane in its own level, `linear` or not.
HWY_INLINE Color sampleLevelVector(const Texture::Data& t, const FootprintVector& p, VI level, MF linear) {
  const I d;
  const F f;
  const LevelTables& l = t.tables;
  const TapVector x = tapsOf(wrappedVector(p.u, t.sampler.wrapU), lookUp(f, l.width, level),
                             lookUp(d, l.lastColumn, level), linear);
  const TapVector y = tapsOf(wrappedVector(p.v, t.sampler.wrapV), lookUp(f, l.height, level),
                             lookUp(d, l.lastRow, level), linear);
  const VI stride = lookUp(d, l.stride, level);
  const VI upper = hn::Add(hn::Add(lookUp(d, l.origin, level), hn::Mul(y.texel, stride)), x.texel);
  alignas(64) std::int32_t upperAt[kLanes], lowerAt[kLanes];
  hn::Store(upper, d, upperAt);
  hn::Store(hn::Add(upper, stride), d, lowerAt);
  const Color a = alongRow(fetchPairs(t.texels.data(), upperAt), x.share);
  const Color b = alongRow(fetchPairs(t.texels.data(), lowerAt), x.share);
  const auto channel = [&](VF from, VF to) {
    return hn::Mul(hn::Add(from, hn::Mul(hn::Sub(to, from), y.share)), hn::Set(f, 1.0F / 65535.0F));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

/// sample() of texel.h.
HWY_INLINE Color sampleVector(const Texture::Data& t, const FootprintVector& p) {
  const I d;
  const F f;
  const VF lambda = levelOfVector(t, p);
  const VI last = hn::Set(d, static_cast<std::int32_t>(t.levels.size()) - 1);
  const MF smaller = hn::Gt(lambda, hn::Zero(f));
  const Filter filter = t.sampler.minification;
  const bool nearestMip = filter == Filter::kNearestMipNearest || filter == Filter::kLinearMipNearest;
  const bool oneLevel = filter == Filter::kNearest || filter == Filter::kLinear;
  const bool minifiesLinearly =
      filter == Filter::kLinear || filter == Filter::kLinearMipNearest || filter == Filter::kLinearMipLinear;
  const MF all = hn::FirstN(f, kLanes), none = hn::Not(all);
  const MF linear =
      hn::Or(minifiesLinearly ? smaller : none, t.sampler.linearMagnification ? hn::Not(smaller) : none);

  const VF rounded = nearestMip ? hn::Add(lambda, hn::Set(f, 0.5F)) : lambda;
  const VI chosen = oneLevel ? hn::Zero(d) : hn::Min(hn::ConvertTo(d, rounded), last);
  const VI level = hn::IfThenElseZero(hn::RebindMask(d, smaller), hn::Max(chosen, hn::Zero(d)));
  Color color = sampleLevelVector(t, p, level, linear);
  if (oneLevel || nearestMip) return color;
  const MF between = hn::And(smaller, hn::RebindMask(f, hn::Lt(level, last)));
  if (hn::AllFalse(f, between)) return color;
  const Color coarse = sampleLevelVector(t, p, hn::Min(hn::Add(level, hn::Set(d, 1)), last), linear);
  const VF share = hn::Sub(lambda, hn::ConvertTo(f, level));
  const auto mix = [&](VF& fine, VF other) {
    fine = hn::IfThenElse(between, hn::Add(fine, hn::Mul(hn::Sub(other, fine), share)), fine);
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
