#include "silhouette/alpha_kernel.h"

#include <cstring>

#include "silhouette/silhouetteness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "silhouette/alpha_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, as Highway wants it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace limn::silhouette::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using V = hn::Vec<Tag>;

// Comparisons choose as in the scalar twin: what std::min and std::max return for equal numbers differs in the sign of
// a zero at most, which no result depends on.
V contour(V low, V high, V least, V most, V beta) {
  const Tag tag;
  const V f = hn::Mul(hn::Min(low, least), hn::Max(high, most));
  const V blended = hn::Sub(hn::Set(tag, 1.0f), hn::Div(f, beta));
  const V some = hn::IfThenZeroElse(hn::Ge(f, beta), blended);
  return hn::IfThenElse(hn::Le(f, hn::Zero(tag)), hn::Set(tag, 1.0f), some);
}

V crossing(V low, V high, V least, V most, V beta) {
  const Tag tag;
  const V zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  const V a = hn::Abs(low), b = hn::Abs(high);
  const V ends = hn::Mul(hn::Mul(hn::Set(tag, 2.0f), hn::Div(a, hn::Add(a, b))), b);
  const V beyond = hn::IfThenElse(hn::Gt(low, zero), hn::Neg(least), most);
  const V within = hn::IfThenElseZero(
      hn::Gt(beyond, zero), hn::Div(beyond, hn::Add(beyond, hn::Mul(hn::Set(tag, kFadeShare), ends))));
  const V spread = hn::Sub(hn::Max(high, most), hn::Min(low, least));
  const V outside = hn::Sub(one, hn::Div(ends, hn::Mul(beta, spread)));
  const V alpha = hn::IfThenElse(hn::Gt(outside, within), outside, within);
  return hn::IfThenElse(hn::And(hn::Le(low, zero), hn::Ge(high, zero)), one, alpha);
}

std::uint64_t alphas(const EdgeBlock& edges, bool isCrossing, float threshold, float* out) {
  const Tag tag;
  const hn::Rebind<std::int32_t, Tag> indexTag;
  const hn::Rebind<std::uint16_t, Tag> cornerTag;
  const std::size_t lanes = hn::Lanes(tag);
  std::uint64_t bends = 0;
  for (std::size_t i = 0; i < kEdgesPerCluster; i += lanes) {
    const auto facing = [&](std::size_t k) {
      const auto corner = hn::LoadU(cornerTag, edges.corners + k * kEdgesPerCluster + i);
      return hn::GatherIndex(tag, edges.facings, hn::PromoteTo(indexTag, corner));
    };
    const V g0 = facing(0), g1 = facing(1), g3 = facing(3), g4 = facing(4), s = facing(2), t = facing(5);
    const V low = hn::Min(hn::Min(g0, g1), hn::Min(g3, g4)), high = hn::Max(hn::Max(g0, g1), hn::Max(g3, g4));
    const V least = hn::Min(s, t), most = hn::Max(s, t), beta = hn::LoadU(tag, edges.betas + i);
    const V alpha =
        isCrossing ? crossing(low, high, least, most, beta) : contour(low, high, least, most, beta);
    hn::StoreU(alpha, tag, out + i);
    const V rise = hn::Mul(alpha, hn::LoadU(tag, edges.bulges + i));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(tag, hn::And(hn::Gt(alpha, hn::Zero(tag)), hn::Gt(rise, hn::Set(tag, threshold))),
                      bits);
    std::uint64_t word;
    std::memcpy(&word, bits, sizeof word);
    bends |= word << i;
  }
  return bends;
}

}  // namespace limn::silhouette::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::silhouette {

HWY_EXPORT(alphas);

std::uint64_t computeAlphas(const EdgeBlock& edges, bool crossing, float threshold, float* alphas) {
  return HWY_DYNAMIC_DISPATCH(alphas)(edges, crossing, threshold, alphas);
}

std::uint64_t computeAlphasScalar(const EdgeBlock& edges, bool crossing, float threshold, float* alphas) {
  std::uint64_t bends = 0;
  for (std::size_t i = 0; i < kEdgesPerCluster; ++i) {
    const auto facing = [&](std::size_t k) { return edges.facings[edges.corners[k * kEdgesPerCluster + i]]; };
    const EdgeFacings g{std::min(std::min(facing(0), facing(1)), std::min(facing(3), facing(4))),
                        std::max(std::max(facing(0), facing(1)), std::max(facing(3), facing(4))),
                        {facing(2), facing(5)}};
    alphas[i] =
        crossing ? crossingSilhouetteness(g, edges.betas[i]) : contourSilhouetteness(g, edges.betas[i]);
    if (alphas[i] > 0.0f && alphas[i] * edges.bulges[i] > threshold) bends |= std::uint64_t{1} << i;
  }
  return bends;
}

}  // namespace limn::silhouette
#endif
