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
  const VF w = hn::Set(f, t.tables.width[0]), h = hn::Set(f, t.tables.height[0]);
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

/// tapOf() of texel.h where all lanes are linear: of a coordinate in [0, 1] none lies beyond the level and its border.
HWY_INLINE TapVector linearTapsOf(VF wrappedU, VF size) {
  const F f;
  const VF x = hn::Sub(hn::Mul(wrappedU, size), hn::Set(f, 0.5F)), base = hn::Floor(x);
  return {wholeOf(base), hn::Sub(x, base)};
}

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

/// One load of 128 bits for each lane; four lanes at a time are turned into numbers of their own.
HWY_INLINE TexelPairs fetchPairs(const std::uint16_t* texels, const std::int32_t* at) {
  const I d;
  const auto pair = [&](std::size_t lane) {
    return reinterpret_cast<const std::int32_t*>(texels + 4 * static_cast<std::ptrdiff_t>(at[lane]));
  };
  const VI rows[4] = {loadEveryFourth(d, 0, pair), loadEveryFourth(d, 1, pair), loadEveryFourth(d, 2, pair),
                      loadEveryFourth(d, 3, pair)};
  TexelPairs p;
  transpose(d, rows, p.redGreen, p.blueAlpha, p.nextRedGreen, p.nextBlueAlpha);
  return p;
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

/// Points at which a texture is sampled, with what the steps of sampling hand on. Steps go over all points: what one
/// stores is addresses for the next, which could not be taken out of a vector as fast as they are loaded.
struct TextureBatch {
  static constexpr std::size_t kSize = PointBatch::kSize;
  alignas(64) float u[kSize], v[kSize], lambda[kSize];
  alignas(64) std::int32_t upper[kSize], lower[kSize];
  alignas(64) float shareX[kSize], shareY[kSize], fine[3][kSize];
};

HWY_INLINE void storeFootprint(const Texture::Data& texture, const FootprintVector& p, TextureBatch& batch,
                               std::size_t i) {
  const F f;
  hn::Store(p.u, f, batch.u + i);
  hn::Store(p.v, f, batch.v + i);
  hn::Store(levelOfVector(texture, p), f, batch.lambda + i);
}

/// sample() of texel.h.
class TextureSampler {
 public:
  TextureSampler(const Texture::Data& texture, TextureBatch& batch) : t_(texture), p_(batch) {
    const Filter filter = t_.sampler.minification;
    nearestMip_ = filter == Filter::kNearestMipNearest || filter == Filter::kLinearMipNearest;
    oneLevel_ = filter == Filter::kNearest || filter == Filter::kLinear;
    minifiesLinearly_ = filter == Filter::kLinear || filter == Filter::kLinearMipNearest ||
                        filter == Filter::kLinearMipLinear;
    allLinear_ = minifiesLinearly_ && t_.sampler.linearMagnification;
  }

  /// Calls body(i, colour) for the points [i, i + kLanes) of `count`, a multiple of that.
  template <class Body>
  HWY_INLINE void operator()(std::size_t count, const Body& body) const {
    setTaps(count, hn::Zero(I()));
    if (oneLevel_ || nearestMip_) {
      for (std::size_t i = 0; i < count; i += kLanes) body(i, texelAt(i));
      return;
    }
    for (std::size_t i = 0; i < count; i += kLanes) {
      const Color fine = texelAt(i);
      hn::Store(fine.r, F(), p_.fine[0] + i);
      hn::Store(fine.g, F(), p_.fine[1] + i);
      hn::Store(fine.b, F(), p_.fine[2] + i);
    }
    setTaps(count, hn::Set(I(), 1));
    for (std::size_t i = 0; i < count; i += kLanes) body(i, mixed(i, texelAt(i)));
  }

 private:
  struct Chosen {
    VI level;
    MF smaller, linear;
  };

  HWY_INLINE VI lastLevel() const { return hn::Set(I(), static_cast<std::int32_t>(t_.levels.size()) - 1); }

  HWY_INLINE Chosen chosenAt(VF lambda) const {
    const I d;
    const F f;
    const MF smaller = hn::Gt(lambda, hn::Zero(f));
    const MF all = hn::FirstN(f, kLanes), none = hn::Not(all);
    const MF linear =
        hn::Or(minifiesLinearly_ ? smaller : none, t_.sampler.linearMagnification ? hn::Not(smaller) : none);
    const VF rounded = nearestMip_ ? hn::Add(lambda, hn::Set(f, 0.5F)) : lambda;
    const VI chosen = oneLevel_ ? hn::Zero(d) : hn::Min(wholeOf(rounded), lastLevel());
    return {hn::IfThenElseZero(hn::RebindMask(d, smaller), hn::Max(chosen, hn::Zero(d))), smaller, linear};
  }

  // Where the texels of all points lie, each point in a level `coarser` than its own.
  HWY_INLINE void setTaps(std::size_t count, VI coarser) const {
    if (allLinear_)
      for (std::size_t i = 0; i < count; i += kLanes) setTaps<true>(i, coarser);
    else
      for (std::size_t i = 0; i < count; i += kLanes) setTaps<false>(i, coarser);
  }

  template <bool kAllLinear>
  HWY_INLINE void setTaps(std::size_t i, VI coarser) const {
    const I d;
    const F f;
    const LevelTables& l = t_.tables;
    const Chosen chosen = chosenAt(hn::Load(f, p_.lambda + i));
    const VI level = hn::Min(hn::Add(chosen.level, coarser), lastLevel());
    const VF u = wrappedVector(hn::Load(f, p_.u + i), t_.sampler.wrapU), width = lookUp(f, l.width, level);
    const VF v = wrappedVector(hn::Load(f, p_.v + i), t_.sampler.wrapV), height = lookUp(f, l.height, level);
    TapVector x, y;
    if constexpr (kAllLinear) {
      x = linearTapsOf(u, width), y = linearTapsOf(v, height);
    } else {
      x = tapsOf(u, width, lookUp(d, l.lastColumn, level), chosen.linear);
      y = tapsOf(v, height, lookUp(d, l.lastRow, level), chosen.linear);
    }
    const VI stride = lookUp(d, l.stride, level);
    const VI upper = hn::Add(hn::Add(lookUp(d, l.origin, level), hn::Mul(y.texel, stride)), x.texel);
    hn::Store(upper, d, p_.upper + i);
    hn::Store(hn::Add(upper, stride), d, p_.lower + i);
    hn::Store(x.share, f, p_.shareX + i);
    hn::Store(y.share, f, p_.shareY + i);
  }

  // sampleLevel() of texel.h.
  HWY_INLINE Color texelAt(std::size_t i) const {
    const F f;
    const VF shareX = hn::Load(f, p_.shareX + i), shareY = hn::Load(f, p_.shareY + i);
    const Color a = alongRow(fetchPairs(t_.texels.data(), p_.upper + i), shareX);
    const Color b = alongRow(fetchPairs(t_.texels.data(), p_.lower + i), shareX);
    const auto channel = [&](VF from, VF to) HWY_ATTR {
      return hn::Mul(hn::Add(from, hn::Mul(hn::Sub(to, from), shareY)), hn::Set(f, 1.0F / 65535.0F));
    };
    return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
  }

  // Between the level of each point and the next.
  HWY_INLINE Color mixed(std::size_t i, const Color& coarse) const {
    const F f;
    const VF lambda = hn::Load(f, p_.lambda + i);
    const Chosen chosen = chosenAt(lambda);
    const MF between = hn::And(chosen.smaller, hn::RebindMask(f, hn::Lt(chosen.level, lastLevel())));
    const VF share = hn::Sub(lambda, hn::ConvertTo(f, chosen.level));
    const auto mix = [&](int k, VF other) HWY_ATTR {
      const VF fine = hn::Load(f, p_.fine[k] + i);
      return hn::IfThenElse(between, hn::Add(fine, hn::Mul(hn::Sub(other, fine), share)), fine);
    };
    return {mix(0, coarse.r), mix(1, coarse.g), mix(2, coarse.b)};
  }

  const Texture::Data& t_;
  TextureBatch& p_;
  bool nearestMip_, oneLevel_, minifiesLinearly_, allLinear_;
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
