// Triangles drawn one by one, in rows of a vector of pixels. Definition: drawTriangle in visibility.cpp.
//
// Depth and triangle are kept per sample, and what shading interpolates per pixel: doing that here, where a row's
// triangle is known, costs three stores, while shading would have to find the triangles of every vector of pixels again.
#if defined(LIMN_RASTER_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_ROWS_INL_H_
#undef LIMN_RASTER_ROWS_INL_H_
#else
#define LIMN_RASTER_ROWS_INL_H_
#endif

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

/// Edge functions, divided by 256, of one triangle over a box of the tile's pixels.
struct RowBox {
  int x0, y0, columns, rows;
  std::int32_t value[kMaxSamples][3];  ///< at the samples of the first pixel
  std::int32_t stepX[3], stepY[3];
};

class Rows {
 public:
  explicit Rows(Tile& tile) : tile_(tile), samples_(tile.context->samples) {
    bool asked = tile.plainMaterial == nullptr;  // textures and vertex colours are divided by it
    for (const Light& light : tile.context->frame.lights) asked |= light.kind != Light::Kind::kDirectional;
    keepsDepth_ = asked && samples_.size() > 1;
  }

  /// Draws a queue of triangles without slivers whose edge functions fit 32 bits.
  void draw(const ClusterInTile& cluster, const TriangleQueue& queue) {
    for (std::size_t i = 0; i < queue.count; i += kLanes) {
      prepare(queue, i);
      for (std::size_t lane = 0; lane < kLanes && i + lane < queue.count; ++lane) {
        cluster.setRecord(static_cast<std::uint32_t>(queue.tag[i + lane]), basis_[0][lane], basis_[1][lane],
                          basis_[2][lane], basis_[3][lane], tile_.records[tile_.recordCount]);
        if (tile_.keepsCorners())
          for (int k = 0; k < 3; ++k)
            tile_.corners[tile_.recordCount].x[k] = queue.x[k][i + lane],
            tile_.corners[tile_.recordCount].y[k] = queue.y[k][i + lane];
        draw(boxes_[lane]);
      }
    }
  }

  /// Draws the record that is next to be kept, over the pixels [x0, x1) × [y0, y1) of the tile.
  void draw(const Corners& c, int x0, int y0, int x1, int y1) {
    RowBox box{x0, y0, x1 - x0, y1 - y0, {}, {}, {}};
    for (int k = 0; k < 3; ++k)
      if (!setEdge(c, k, box)) return;
    draw(box);
  }

 private:
  static constexpr std::size_t kMaxRows = 64;
  using RowStarts = float[kMaxRows + kLanes];

  HWY_INLINE void prepare(const TriangleQueue& queue, std::size_t first) {
    const I d;
    const F f;
    const TriangleVector t(tile_, queue, first);
    hn::Store(t.x1, f, basis_[0]), hn::Store(t.x2, f, basis_[1]);
    hn::Store(t.y1, f, basis_[2]), hn::Store(t.y2, f, basis_[3]);
    alignas(64) std::int32_t lanes[kLanes];
    const auto scatter = [&](VI v, const auto& member) {
      hn::Store(v, d, lanes);
      for (std::size_t i = 0; i < kLanes; ++i) member(boxes_[i]) = lanes[i];
    };
    const VI one = hn::Set(d, 1);
    scatter(hn::Sub(t.px.first, hn::Set(d, tile_.left)), [](RowBox& b) -> int& { return b.x0; });
    scatter(hn::Sub(t.py.first, hn::Set(d, tile_.top)), [](RowBox& b) -> int& { return b.y0; });
    scatter(hn::Add(hn::Sub(t.px.last, t.px.first), one), [](RowBox& b) -> int& { return b.columns; });
    scatter(hn::Add(hn::Sub(t.py.last, t.py.first), one), [](RowBox& b) -> int& { return b.rows; });
    for (int k = 0; k < 3; ++k) {
      scatter(hn::Neg(t.edgeY[k]), [k](RowBox& b) -> int& { return b.stepX[k]; });
      scatter(t.edgeX[k], [k](RowBox& b) -> int& { return b.stepY[k]; });
      for (std::size_t s = 0; s < samples_.size(); ++s)
        scatter(hn::ShiftRight<kSubpixelBits>(t.edgeAt(k, samples_[s])),
                [k, s](RowBox& b) -> int& { return b.value[s][k]; });
    }
  }

  // False: no sample of the box is inside. An edge that all of them are inside of becomes 0, so that the others,
  // whose values change sign within the box, fit 32 bits.
  bool setEdge(const Corners& c, int k, RowBox& box) const {
    const Edge edge = Edge::of(c, k, k == 2 ? 0 : k + 1);
    const std::int64_t stepX = -static_cast<std::int64_t>(edge.dy), stepY = edge.dx;
    const std::int64_t acrossX = stepX * (box.columns - 1), acrossY = stepY * (box.rows - 1);
    // Whole vectors are drawn, so lanes beyond the box must be outside of some edge, too.
    constexpr auto kLast = static_cast<std::int64_t>(kLanes) - 1;
    const std::int64_t overX = stepX * (box.columns - 1 + kLast);
    bool inside = true, outside = true;
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const std::int32_t px = (tile_.left + box.x0) * kSubpixels + samples_[s].x,
                         py = (tile_.top + box.y0) * kSubpixels + samples_[s].y;
      const std::int64_t value = edge.at(px, py) >> kSubpixelBits;
      inside &= value + std::min<std::int64_t>(overX, 0) + std::min<std::int64_t>(acrossY, 0) >= 0;
      outside &= value + std::max<std::int64_t>(acrossX, 0) + std::max<std::int64_t>(acrossY, 0) < 0;
      box.value[s][k] = static_cast<std::int32_t>(value);
    }
    box.stepX[k] = inside ? 0 : -edge.dy;
    box.stepY[k] = inside ? 0 : edge.dx;
    if (inside)
      for (std::size_t s = 0; s < samples_.size(); ++s) box.value[s][k] = 0;
    return !outside;
  }

  HWY_INLINE void draw(const RowBox& box) {
    bool won = false;
    if (samples_.size() == 1)
      won = drawBox<1>(box);
    else if (samples_.size() == 4)
      won = drawBox<4>(box);
    else
      won = drawBox<8>(box);
    if (won) ++tile_.recordCount;
  }

  // The rows' starts, origin + slopeY · dy, of planes [first, last) at a height of the first row.
  HWY_INLINE static void startRows(const Record& record, int first, int last, std::int32_t dy, int rows,
                                   RowStarts* to) {
    const I d;
    const F f;
    const VI ramp = hn::ShiftLeft<kSubpixelBits>(hn::Iota(d, 0));
    for (int row = 0; row < rows; row += static_cast<int>(kLanes)) {
      const VF at = hn::ConvertTo(f, hn::Add(hn::Set(d, dy + row * kSubpixels), ramp));
      for (int i = first; i < last; ++i)
        hn::Store(hn::Add(hn::Set(f, record.origin[i]), hn::Mul(hn::Set(f, record.slopeY[i]), at)), f,
                  to[i - first] + row);
    }
  }

  template <std::size_t kSamples>
  HWY_INLINE bool drawBox(const RowBox& box) {
    const I d;
    const F f;
    const Record& record = tile_.records[tile_.recordCount];
    const VI number = hn::Set(d, static_cast<std::int32_t>(tile_.recordCount));
    const std::int32_t px = (tile_.left + box.x0) * kSubpixels - record.x0,
                       py = (tile_.top + box.y0) * kSubpixels - record.y0;
    const bool keepsDepth = keepsDepth_;
    // At one sample per pixel, that is the pixel's centre, and its depths are the fourth plane.
    startRows(record, 0, 4, py + kOneSample[0].y, box.rows, starts_);
    if (kSamples > 1)
      for (std::size_t s = 0; s < kSamples; ++s)
        startRows(record, 3, 4, py + samples_[s].y, box.rows, &depthStarts_[s]);
    const RowStarts* const depthStarts = kSamples > 1 ? depthStarts_ : starts_ + 3;
    const std::size_t plane = tile_.offset(1, 0, 0);
    constexpr std::make_index_sequence<kSamples> samples;
    const VI ramp = hn::Iota(d, 0), fine = hn::ShiftLeft<kSubpixelBits>(ramp);
    const auto across = [&](int i, std::int32_t x) {
      return hn::Mul(hn::Set(f, record.slopeX[i]), hn::ConvertTo(f, hn::Add(hn::Set(d, px + x), fine)));
    };
    const VI step0 = hn::Set(d, box.stepY[0]), step1 = hn::Set(d, box.stepY[1]),
             step2 = hn::Set(d, box.stepY[2]);
    float* const depths = tile_.depth.data();
    std::uint32_t* const ids = tile_.ids.data();
    float *const normalX = tile_.normal[0].data(), *const normalY = tile_.normal[1].data(),
                 *const normalZ = tile_.normal[2].data(), *const centers = tile_.centerDepth.data();
    const auto stride = static_cast<std::size_t>(tile_.stride);
    const int rows = box.rows;
    MI won = hn::FirstN(d, 0);
    for (int column = 0; column < box.columns; column += static_cast<int>(kLanes)) {
      VI e[kSamples][3];
      VF zX[kSamples];
      forEach(samples, [&](auto s) HWY_ATTR {
        for (int k = 0; k < 3; ++k)
          e[s][k] = hn::Add(hn::Set(d, box.value[s][k] + box.stepX[k] * column),
                            hn::Mul(ramp, hn::Set(d, box.stepX[k])));
        zX[s] = across(3, (kSamples > 1 ? samples_[s].x : kOneSample[0].x) + column * kSubpixels);
      });
      const std::int32_t center = kOneSample[0].x + column * kSubpixels;
      const VF xX = across(0, center), yX = across(1, center), nX = across(2, center), dX = across(3, center);
      std::size_t o = tile_.offset(0, box.x0 + column, box.y0);
      for (int row = 0; row < rows; ++row, o += stride) {
        MI any = hn::FirstN(d, 0);
        forEach(samples, [&](auto s) HWY_ATTR {
          float* const depth = depths + o + s * plane;
          std::uint32_t* const id = ids + o + s * plane;
          const VF z = hn::Add(hn::Set(f, depthStarts[s][row]), zX[s]);
          const VF old = hn::LoadU(f, depth);
          const MI covered = hn::Gt(hn::Or(hn::Or(e[s][0], e[s][1]), e[s][2]), hn::Set(d, -1));
          MI wins = hn::And(covered, hn::RebindMask(d, hn::Ge(z, old)));
          const MI ties = hn::And(covered, hn::RebindMask(d, hn::Eq(z, old)));
          if (HWY_UNLIKELY(!hn::AllFalse(d, ties))) wins = settleTies(tile_, record, id, wins, ties);
          storeWhere(z, hn::RebindMask(f, wins), f, depth);
          storeWhere(number, wins, d, reinterpret_cast<std::int32_t*>(id));
          any = hn::Or(any, wins);
          e[s][0] = hn::Add(e[s][0], step0), e[s][1] = hn::Add(e[s][1], step1),
          e[s][2] = hn::Add(e[s][2], step2);
        });
        const MF points = hn::RebindMask(f, any);
        storeWhere(hn::Add(hn::Set(f, starts_[0][row]), xX), points, f, normalX + o);
        storeWhere(hn::Add(hn::Set(f, starts_[1][row]), yX), points, f, normalY + o);
        storeWhere(hn::Add(hn::Set(f, starts_[2][row]), nX), points, f, normalZ + o);
        if (keepsDepth) storeWhere(hn::Add(hn::Set(f, starts_[3][row]), dX), points, f, centers + o);
        won = hn::Or(won, any);
      }
    }
    return !hn::AllFalse(d, won);
  }

  Tile& tile_;
  std::span<const SamplePosition> samples_;
  bool keepsDepth_ = false;  // shading asks for the depths of pixel centres, and no sample lies there
  RowBox boxes_[kLanes];     // of a vector of triangles
  alignas(64) float basis_[4][kLanes];
  alignas(64) RowStarts starts_[4],
      depthStarts_[kMaxSamples];  // at pixel centres, of all planes; of depth at the samples
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
