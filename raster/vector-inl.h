// The vector types of the kernels: at most 16 lanes, a row of a tile's strip.
#if defined(LIMN_RASTER_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_VECTOR_INL_H_
#undef LIMN_RASTER_VECTOR_INL_H_
#else
#define LIMN_RASTER_VECTOR_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <utility>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
namespace hn = hwy::HWY_NAMESPACE;

using F = HWY_CAPPED(float, 16);
using F4 = HWY_CAPPED(float, 4);
using I = hn::Rebind<std::int32_t, F>;
using U8 = hn::Rebind<std::uint8_t, F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using MI = hn::Mask<I>;
using MF = hn::Mask<F>;

inline constexpr std::size_t kLanes = HWY_LANES(float) < 16 ? HWY_LANES(float) : 16;

HWY_INLINE MI atLeast(VI a, VI b) {
  return hn::Not(hn::Lt(a, b));
}
HWY_INLINE MI atMost(VI a, VI b) {
  return hn::Not(hn::Gt(a, b));
}

/// (a·b + c·d) + e·f, in that order.
HWY_INLINE VF dot3(VF a, VF b, VF c, VF d, VF e, VF f) {
  return hn::Add(hn::Add(hn::Mul(a, b), hn::Mul(c, d)), hn::Mul(e, f));
}

/// The whole part of numbers in the range of integers. hn::ConvertTo() also takes care of others.
HWY_INLINE VI wholeOf(VF v) {
#if HWY_TARGET <= HWY_AVX3
  return VI{_mm512_maskz_cvttps_epi32(0xffff, v.raw)};  // g++ warns of the other one
#elif HWY_TARGET <= HWY_AVX2
  return VI{_mm256_cvttps_epi32(v.raw)};
#else
  return hn::ConvertTo(I(), v);
#endif
}

/// body(0), body(1) …, each with a constant: unrolled, so that what is kept per sample can stay in registers.
template <std::size_t... kIndices, class Body>
HWY_INLINE void forEach(std::index_sequence<kIndices...> /*indices*/, const Body& body) {
  (body(std::integral_constant<std::size_t, kIndices>()), ...);
}

/// Bit i: lane i is set.
HWY_INLINE unsigned bitsOf(MI lanes) {
#if HWY_TARGET <= HWY_AVX3
  return lanes.raw;
#elif HWY_TARGET <= HWY_AVX2
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(lanes.raw)));
#else
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(I(), lanes, bits);
  return bits[0] | (static_cast<unsigned>(bits[1]) << 8U);
#endif
}

/// Lane i: bit i is set.
HWY_INLINE MI lanesOf(unsigned lanes) {
#if HWY_TARGET <= HWY_AVX3
  return MI{static_cast<__mmask16>(lanes)};
#else
  const std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes), static_cast<std::uint8_t>(lanes >> 8U)};
  return hn::LoadMaskBits(I(), bits);
#endif
}

#if HWY_TARGET > HWY_AVX3
/// For each set of lanes: its lanes one after the other, and how many of them come before each lane.
struct LaneSets {
  static_assert(kLanes <= 8);
  std::uint8_t lanes[1U << kLanes][kLanes], before[1U << kLanes][kLanes];
};
inline constexpr LaneSets kLaneSets = [] {
  LaneSets all{};
  for (std::size_t set = 0; set < std::size(all.lanes); ++set)
    for (std::size_t lane = 0, count = 0; lane < kLanes; ++lane) {
      all.before[set][lane] = static_cast<std::uint8_t>(count < kLanes ? count : 0);
      if ((set >> lane & 1U) != 0) all.lanes[set][count++] = static_cast<std::uint8_t>(lane);
    }
  return all;
}();

/// The numbers of `from`, picked by their numbers.
template <class V>
HWY_INLINE V picked(V from, const std::uint8_t* which) {
  const hn::DFromV<V> d;
  return hn::TableLookupLanes(from, hn::IndicesFromVec(d, hn::PromoteTo(I(), hn::LoadU(U8(), which))));
}
#endif

/// The numbers in the lanes of a mask, one after the other.
template <class V>
HWY_INLINE V compressed(V v, MI lanes) {
#if HWY_TARGET == HWY_AVX2  // g++ makes hn::Compress() copy its table at each call
  return picked(v, kLaneSets.lanes[bitsOf(lanes)]);
#else
  return hn::Compress(v, hn::RebindMask(hn::DFromV<V>(), lanes));
#endif
}

/// Of four vectors' numbers at `from`, those at 0, 4, 8 …, at 1, 5, 9 …, and so on.
template <class D, class V>
HWY_INLINE void loadColumns(D d, const hn::TFromD<D>* from, V& c0, V& c1, V& c2, V& c3) {
#if HWY_TARGET <= HWY_AVX3
  // Half of the shuffles of LoadInterleaved4.
  alignas(64) static constexpr std::int32_t kFirst[16] = {0, 4, 8, 12, 16, 20, 24, 28,
                                                          1, 5, 9, 13, 17, 21, 25, 29},
                                            kLast[16] = {2, 6, 10, 14, 18, 22, 26, 30,
                                                         3, 7, 11, 15, 19, 23, 27, 31};
  const __m512i first = _mm512_load_si512(kFirst), last = _mm512_load_si512(kLast);
  const auto pick = [&](std::size_t i, __m512i which) HWY_ATTR {
    return hn::BitCast(d, VI{_mm512_permutex2var_epi32(_mm512_load_si512(from + i), which,
                                                       _mm512_load_si512(from + i + kLanes))});
  };
  const V low01 = pick(0, first), high01 = pick(2 * kLanes, first);
  const V low23 = pick(0, last), high23 = pick(2 * kLanes, last);
  c0 = hn::ConcatLowerLower(d, high01, low01), c1 = hn::ConcatUpperUpper(d, high01, low01);
  c2 = hn::ConcatLowerLower(d, high23, low23), c3 = hn::ConcatUpperUpper(d, high23, low23);
#else
  hn::LoadInterleaved4(d, from, c0, c1, c2, c3);
#endif
}

/// The 128 bits at(lane), at(lane + 4), at(lane + 8) … side by side.
template <class D, class At>
HWY_INLINE hn::Vec<D> loadEveryFourth(D d, std::size_t lane, const At& at) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, at(lane));
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, loadEveryFourth(half, lane + hn::MaxLanes(half), at),
                       loadEveryFourth(half, lane, at));
  }
}

/// The columns of rows of four numbers each, loaded by loadEveryFourth() from lanes 0, 1, 2, 3 on.
template <class D, class V>
HWY_INLINE void transpose(D d, const V (&rows)[4], V& c0, V& c1, V& c2, V& c3) {
  const V low02 = hn::InterleaveLower(d, rows[0], rows[2]), low13 = hn::InterleaveLower(d, rows[1], rows[3]);
  const V high02 = hn::InterleaveUpper(d, rows[0], rows[2]),
          high13 = hn::InterleaveUpper(d, rows[1], rows[3]);
  c0 = hn::InterleaveLower(d, low02, low13), c1 = hn::InterleaveUpper(d, low02, low13);
  c2 = hn::InterleaveLower(d, high02, high13), c3 = hn::InterleaveUpper(d, high02, high13);
}

/// Where a number differs from that of the lane before; the first lane does.
HWY_INLINE MI startsOf(VI v) {
  const I d;
  alignas(64) static constexpr std::int32_t kBefore[16] = {0, 0, 1, 2,  3,  4,  5,  6,
                                                           7, 8, 9, 10, 11, 12, 13, 14};
  const VI before = hn::TableLookupLanes(v, hn::IndicesFromVec(d, hn::Load(d, kBefore)));
  return hn::Or(hn::Ne(v, before), hn::FirstN(d, 1));
}

/// The next numbers at `from` in the lanes whose bits are set, 0 in the others. Reads a whole vector.
HWY_INLINE VF expanded(const float* from, unsigned lanes) {
#if HWY_TARGET <= HWY_AVX3
  return VF{_mm512_maskz_expand_ps(static_cast<__mmask16>(lanes), _mm512_loadu_ps(from))};
#else
  const VF spread = picked(hn::LoadU(F(), from), kLaneSets.before[lanes]);
  return hn::IfThenElseZero(hn::RebindMask(F(), lanesOf(lanes)), spread);
#endif
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
