// The vector types of the kernels: at most 16 lanes, a row of a tile's strip.
#if defined(LIMN_RASTER_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_VECTOR_INL_H_
#undef LIMN_RASTER_VECTOR_INL_H_
#else
#define LIMN_RASTER_VECTOR_INL_H_
#endif

#include <cstddef>
#include <cstdint>
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

/// body(0), body(1) …, each with a constant: unrolled, so that what is kept per sample can stay in registers.
template <std::size_t... kIndices, class Body>
HWY_INLINE void forEach(std::index_sequence<kIndices...> /*indices*/, const Body& body) {
  (body(std::integral_constant<std::size_t, kIndices>()), ...);
}

/// Bit i: lane i is set.
HWY_INLINE unsigned bitsOf(MI lanes) {
#if HWY_TARGET <= HWY_AVX3
  return lanes.raw;
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
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
