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

// Facings by their numbers: from registers where 64 of them fill four, which takes half the time of gathering.
class Lookup {
 public:
  explicit Lookup(const EdgeBlock& edges) : facings_(edges.facings), fits_(edges.facingCount <= 64) {
    const Tag tag;
    if constexpr (kInRegisters)
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t at = 16 * k < edges.facingCount ? 16 * k : 0;
        table_[k] = hn::LoadU(tag, facings_ + at);
      }
  }

  V operator()(const std::uint16_t* corners) const {
    const Tag tag;
    const hn::Rebind<std::int32_t, Tag> indexTag;
    const auto index = hn::PromoteTo(indexTag, hn::LoadU(hn::Rebind<std::uint16_t, Tag>(), corners));
    if constexpr (kInRegisters) {
      if (fits_) {
        const auto at = hn::IndicesFromVec(tag, hn::And(index, hn::Set(indexTag, 15)));
        const auto odd = hn::RebindMask(tag, hn::TestBit(index, hn::Set(indexTag, 16)));
        const auto upper = hn::RebindMask(tag, hn::TestBit(index, hn::Set(indexTag, 32)));
        const V low =
            hn::IfThenElse(odd, hn::TableLookupLanes(table_[1], at), hn::TableLookupLanes(table_[0], at));
        const V high =
            hn::IfThenElse(odd, hn::TableLookupLanes(table_[3], at), hn::TableLookupLanes(table_[2], at));
        return hn::IfThenElse(upper, high, low);
      }
    }
    return hn::GatherIndex(tag, facings_, index);
  }

 private:
  static constexpr bool kInRegisters = hn::MaxLanes(Tag()) == 16;

  const float* facings_;
  bool fits_;
  V table_[4] = {hn::Zero(Tag()), hn::Zero(Tag()), hn::Zero(Tag()), hn::Zero(Tag())};
};

std::uint64_t alphas(const EdgeBlock& edges, bool isCrossing, float threshold, float* out) {
  const Tag tag;
  const std::size_t lanes = hn::Lanes(tag);
  const Lookup lookup(edges);
  std::uint64_t bends = 0;
  for (std::size_t i = 0; i < kEdgesPerCluster; i += lanes) {
    const auto facing = [&](std::size_t k) { return lookup(edges.corners + k * kEdgesPerCluster + i); };
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
