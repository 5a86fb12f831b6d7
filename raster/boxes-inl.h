// Triangles of any size made ready to be drawn one by one: their boxes and edge functions. Definition: TriangleSetup.
#if defined(LIMN_RASTER_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_BOXES_INL_H_
#undef LIMN_RASTER_BOXES_INL_H_
#else
#define LIMN_RASTER_BOXES_INL_H_
#endif

#include <algorithm>

#include "raster/cluster-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// Stores the lanes of a mask; the others keep what they hold. Nobody else may write them at the same time.
template <class D, class V, class M>
HWY_INLINE void storeWhere(V v, M lanes, D d, hn::TFromD<D>* to) {
  if constexpr (HWY_TARGET <= HWY_AVX3)
    hn::BlendedStore(v, lanes, d, to);
  else  // masked stores are slow
    hn::StoreU(hn::IfThenElse(lanes, v, hn::LoadU(d, to)), d, to);
}

/// A vector of triangles over boxes of the tile's pixels. Edge functions are divided by 256.
struct Boxes {
  alignas(64) std::int32_t x0[kLanes], y0[kLanes], columns[kLanes], rows[kLanes];
  alignas(64) std::int32_t stepX[3][kLanes], stepY[3][kLanes];
  /// At the first pixel's one sample; of several, the samples of a group side by side.
  alignas(64) std::int32_t value[3][kMaxSamples / kGroup][kGroup * kLanes];
  alignas(64) std::int32_t best[3][kLanes];    ///< the most of all samples of the first pixel
  alignas(64) std::int32_t center[3][kLanes];  ///< at its centre; with several samples
  alignas(64) float basis[4][kLanes];          ///< PlaneBasis

  const std::int32_t* valuesOf(std::size_t lane, int k, std::size_t group) const {
    return &value[k][group][kGroup * lane];
  }

  /// Of queued triangles without slivers whose edge functions fit 32 bits.
  HWY_INLINE void set(const Tile& tile, const TriangleQueue& queue, std::size_t first) {
    const I d;
    const F f;
    const TriangleVector t(tile, queue, first);
    hn::Store(t.x1, f, basis[0]), hn::Store(t.x2, f, basis[1]);
    hn::Store(t.y1, f, basis[2]), hn::Store(t.y2, f, basis[3]);
    const VI one = hn::Set(d, 1);
    hn::Store(hn::Sub(t.px.first, hn::Set(d, tile.left)), d, x0);
    hn::Store(hn::Sub(t.py.first, hn::Set(d, tile.top)), d, y0);
    hn::Store(hn::Add(hn::Sub(t.px.last, t.px.first), one), d, columns);
    hn::Store(hn::Add(hn::Sub(t.py.last, t.py.first), one), d, rows);
    const std::span<const SamplePosition> samples = tile.context->samples;
    for (int k = 0; k < 3; ++k) {
      hn::Store(hn::Neg(t.edgeY[k]), d, stepX[k]);
      hn::Store(t.edgeX[k], d, stepY[k]);
      const auto at = [&](SamplePosition sample)
                          HWY_ATTR { return hn::ShiftRight<kSubpixelBits>(t.edgeAt(k, sample)); };
      if (!tile.hasSeveralSamples()) {
        hn::Store(at(kOneSample[0]), d, value[k][0]);
        hn::Store(at(kOneSample[0]), d, best[k]);
        continue;
      }
      VI most = at(samples[0]);
      for (std::size_t s = 0; s < samples.size(); s += kGroup) {
        const VI v0 = at(samples[s]), v1 = at(samples[s + 1]), v2 = at(samples[s + 2]),
                 v3 = at(samples[s + 3]);
        hn::StoreInterleaved4(v0, v1, v2, v3, d, value[k][s / kGroup]);
        most = hn::Max(most, hn::Max(hn::Max(v0, v1), hn::Max(v2, v3)));
      }
      hn::Store(most, d, best[k]);
      hn::Store(at(kOneSample[0]), d, center[k]);
    }
  }

  /// Of one triangle of any shape, in lane 0. False: no sample of the box is inside. An edge that all of them are inside
  /// of becomes 0, so that the others, whose values change sign within the box, fit 32 bits.
  bool set(const Tile& tile, const Corners& c, int left, int top, int right, int bottom) {
    x0[0] = left, y0[0] = top, columns[0] = right - left, rows[0] = bottom - top;
    for (int k = 0; k < 3; ++k)
      if (!setEdge(tile, Edge::of(c, k, k == 2 ? 0 : k + 1), k)) return false;
    return true;
  }

  /// Readies setRows() for columns of kPixels pixels that begin at multiples of that. The rows with samples inside of an
  /// edge begin or end at a straight line, here moved outwards by more than rounding could be wrong. Edges that say
  /// nothing have lines beyond all rows.
  template <int kPixels>
  HWY_INLINE void setSpans() {
    const I d;
    const F f;
    const VI zero = hn::Zero(d), offset = hn::And(hn::Load(d, x0), hn::Set(d, kPixels - 1));
    for (int k = 0; k < 3; ++k) {
      const VI across = hn::Load(d, stepX[k]), down = hn::Load(d, stepY[k]);
      const VI first = hn::Sub(hn::Load(d, best[k]), hn::Mul(offset, across));
      const VI most = hn::Add(first, hn::Max(zero, hn::Mul(across, hn::Set(d, kPixels - 1))));
      const VF scale = hn::Div(hn::Set(f, -1.0F), hn::ConvertTo(f, down));
      const VF row = hn::Mul(hn::ConvertTo(f, most), scale);
      const VF slope =
          hn::Mul(hn::Mul(hn::ConvertTo(f, across), hn::Set(f, static_cast<float>(kPixels))), scale);
      const VF extent = hn::Add(hn::Abs(row), hn::Mul(hn::Abs(slope), hn::Set(f, 128.0F)));
      const VF slack = hn::Add(hn::Mul(extent, hn::Set(f, 1e-6F)), hn::Set(f, 1.0F / 64.0F));
      const MF begins = hn::RebindMask(f, hn::Gt(down, zero)), ends = hn::RebindMask(f, hn::Lt(down, zero));
      const VF before = hn::Set(f, -1.0F), beyond = hn::Set(f, 100.0F), none = hn::Zero(f);
      hn::Store(hn::IfThenElse(begins, hn::Sub(row, slack), before), f, first_[k]);
      hn::Store(hn::IfThenElse(begins, slope, none), f, firstSlope_[k]);
      hn::Store(hn::IfThenElse(ends, hn::Add(row, slack), beyond), f, last_[k]);
      hn::Store(hn::IfThenElse(ends, slope, none), f, lastSlope_[k]);
    }
  }

  /// First and last row of each of a triangle's `wide` columns, none where first is beyond last.
  HWY_INLINE void setRows(std::size_t lane, int wide) {
    const I d;
    const F f;
    const VF top = hn::Zero(f), bottom = hn::Set(f, static_cast<float>(rows[lane] - 1));
    for (int c = 0; c < wide; c += static_cast<int>(kLanes)) {
      const VF column = hn::ConvertTo(f, hn::Add(hn::Iota(d, 0), hn::Set(d, c)));
      VF first = top, last = bottom;
      for (int k = 0; k < 3; ++k) {
        const auto line = [&](const float* start, const float* slope) HWY_ATTR {
          return hn::Add(hn::Set(f, start[lane]), hn::Mul(hn::Set(f, slope[lane]), column));
        };
        first = hn::Max(first, line(first_[k], firstSlope_[k]));
        last = hn::Min(last, line(last_[k], lastSlope_[k]));
      }
      hn::Store(hn::ConvertTo(d, hn::Ceil(hn::Min(first, hn::Set(f, 64.0F)))), d, firstRow + c);
      hn::Store(hn::ConvertTo(d, hn::Max(last, hn::Set(f, -1.0F))), d, lastRow + c);
    }
  }

  alignas(64) std::int32_t firstRow[128 + kLanes], lastRow[128 + kLanes];  ///< see setRows()

 private:
  alignas(64) float first_[3][kLanes], firstSlope_[3][kLanes], last_[3][kLanes], lastSlope_[3][kLanes];

  bool setEdge(const Tile& tile, const Edge& edge, int k) {
    const std::span<const SamplePosition> samples = tile.context->samples;
    const std::int64_t stepAcross = -static_cast<std::int64_t>(edge.dy), stepDown = edge.dx;
    const std::int64_t acrossX = stepAcross * (columns[0] - 1), acrossY = stepDown * (rows[0] - 1);
    // Whole vectors are drawn, so lanes beyond the box must be outside of some edge, too.
    constexpr auto kLast = static_cast<std::int64_t>(kLanes) - 1;
    const std::int64_t beyondLeft = -stepAcross * kLast, beyondRight = acrossX + stepAcross * kLast;
    bool inside = true, outside = true;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const std::int32_t px = (tile.left + x0[0]) * kSubpixels + samples[s].x,
                         py = (tile.top + y0[0]) * kSubpixels + samples[s].y;
      const std::int64_t at = edge.at(px, py) >> kSubpixelBits;
      inside &= at + std::min(beyondLeft, beyondRight) + std::min<std::int64_t>(acrossY, 0) >= 0;
      outside &= at + std::max<std::int64_t>(acrossX, 0) + std::max<std::int64_t>(acrossY, 0) < 0;
      value[k][s / kGroup][s % kGroup] = static_cast<std::int32_t>(at);
    }
    stepX[k][0] = inside ? 0 : -edge.dy;
    stepY[k][0] = inside ? 0 : edge.dx;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      std::int32_t& at = value[k][s / kGroup][s % kGroup];
      if (inside) at = 0;
      best[k][0] = std::max(s == 0 ? at : best[k][0], at);
    }
    return !outside;
  }
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
