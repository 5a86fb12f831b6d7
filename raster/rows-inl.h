// Triangles drawn one by one, in rows of a vector of pixels of one sample. Definition: drawTriangle in visibility.cpp.
//
// What shading interpolates is kept here, too, where a row's triangle is known: that costs three stores, while shading
// would have to find the triangles of every vector of pixels again.
#if defined(LIMN_RASTER_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_ROWS_INL_H_
#undef LIMN_RASTER_ROWS_INL_H_
#else
#define LIMN_RASTER_ROWS_INL_H_
#endif

#include "raster/boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
class Rows {
 public:
  explicit Rows(Tile& tile) : tile_(tile) {}

  /// Draws a queue of triangles without slivers whose edge functions fit 32 bits.
  void draw(const ClusterInTile& cluster, const TriangleQueue& queue) {
    for (std::size_t i = 0; i < queue.count; i += kLanes) {
      boxes_.set(tile_, queue, i);
      boxes_.setSpans<kColumns>();
      for (std::size_t lane = 0; lane < kLanes && i + lane < queue.count; ++lane) {
        cluster.prepareRecord(tile_, static_cast<std::uint32_t>(queue.tag[i + lane]), boxes_.basis[0][lane],
                              boxes_.basis[1][lane], boxes_.basis[2][lane], boxes_.basis[3][lane]);
        drawBox(lane);
      }
    }
  }

  /// Draws the record that is next to be kept, over the pixels [x0, x1) × [y0, y1) of the tile.
  void draw(const Corners& c, int x0, int y0, int x1, int y1) {
    if (!boxes_.set(tile_, c, x0, y0, x1, y1)) return;
    boxes_.setSpans<kColumns>();
    drawBox(0);
  }

 private:
  static constexpr std::size_t kMaxRows = 64;
  static constexpr int kColumns = static_cast<int>(kLanes);
  using RowStarts = float[kMaxRows + kLanes];

  // The rows' starts, origin + slopeY · dy, of the planes at a height of the first row.
  HWY_INLINE void startRows(const Record& record, std::int32_t dy, int rows) {
    const I d;
    const F f;
    const VI ramp = hn::ShiftLeft<kSubpixelBits>(hn::Iota(d, 0));
    for (int row = 0; row < rows; row += static_cast<int>(kLanes)) {
      const VF at = hn::ConvertTo(f, hn::Add(hn::Set(d, dy + row * kSubpixels), ramp));
      for (int i = 0; i < 4; ++i)
        hn::Store(hn::Add(hn::Set(f, record.origin[i]), hn::Mul(hn::Set(f, record.slopeY[i]), at)), f,
                  starts_[i] + row);
    }
  }

  HWY_INLINE void drawBox(std::size_t lane) {
    const I d;
    const F f;
    const Record& record = tile_.records[tile_.recordCount];
    const VI number = hn::Set(d, static_cast<std::int32_t>(tile_.recordCount));
    const int y0 = boxes_.y0[lane], before = boxes_.x0[lane] % kColumns, x0 = boxes_.x0[lane] - before;
    const int columns = (before + boxes_.columns[lane] + kColumns - 1) / kColumns;
    const std::int32_t px = (tile_.left + x0) * kSubpixels - record.x0 + kOneSample[0].x,
                       py = (tile_.top + y0) * kSubpixels - record.y0 + kOneSample[0].y;
    boxes_.setRows(lane, columns);
    startRows(record, py, boxes_.rows[lane]);
    const VI ramp = hn::Iota(d, 0), fine = hn::ShiftLeft<kSubpixelBits>(ramp);
    float* const depths = tile_.depth.data();
    std::uint32_t* const ids = tile_.ids.data();
    float *const normalX = tile_.normal[0].data(), *const normalY = tile_.normal[1].data(),
                 *const normalZ = tile_.normal[2].data();
    VI start[3], step[3];
    for (int k = 0; k < 3; ++k) {
      step[k] = hn::Set(d, boxes_.stepY[k][lane]);
      const std::int32_t stepX = boxes_.stepX[k][lane];
      start[k] =
          hn::Add(hn::Set(d, boxes_.value[k][0][lane] - before * stepX), hn::Mul(ramp, hn::Set(d, stepX)));
    }
    MI won = hn::FirstN(d, 0);
    for (int column = 0; column < columns; ++column) {
      const int first = boxes_.firstRow[column], last = boxes_.lastRow[column];
      if (first > last) continue;
      VI e[3];
      for (int k = 0; k < 3; ++k)
        e[k] = hn::Add(start[k], hn::Set(d, boxes_.stepX[k][lane] * (column * kColumns) +
                                                boxes_.stepY[k][lane] * first));
      const VF dx = hn::ConvertTo(f, hn::Add(hn::Set(d, px + column * (kColumns * kSubpixels)), fine));
      const VF nxX = hn::Mul(hn::Set(f, record.slopeX[0]), dx),
               nyX = hn::Mul(hn::Set(f, record.slopeX[1]), dx);
      const VF nzX = hn::Mul(hn::Set(f, record.slopeX[2]), dx),
               zX = hn::Mul(hn::Set(f, record.slopeX[3]), dx);
      std::size_t o = tile_.pixelOffset(x0 + column * kColumns, y0 + first);
      for (int row = first; row <= last; ++row, o += Tile::kStripWidth) {
        const VF z = hn::Add(hn::Set(f, starts_[3][row]), zX), old = hn::Load(f, depths + o);
        const MI covered = hn::Gt(hn::Or(hn::Or(e[0], e[1]), e[2]), hn::Set(d, -1));
        MI wins = hn::And(covered, hn::RebindMask(d, hn::Ge(z, old)));
        const MI ties = hn::And(covered, hn::RebindMask(d, hn::Eq(z, old)));
        if (HWY_UNLIKELY(!hn::AllFalse(d, ties))) wins = settleTies(tile_, record, ids + o, wins, ties);
        const MF winsF = hn::RebindMask(f, wins);
        storeWhere(z, winsF, f, depths + o);
        storeWhere(number, wins, d, reinterpret_cast<std::int32_t*>(ids + o));
        storeWhere(hn::Add(hn::Set(f, starts_[0][row]), nxX), winsF, f, normalX + o);
        storeWhere(hn::Add(hn::Set(f, starts_[1][row]), nyX), winsF, f, normalY + o);
        storeWhere(hn::Add(hn::Set(f, starts_[2][row]), nzX), winsF, f, normalZ + o);
        won = hn::Or(won, wins);
        for (int k = 0; k < 3; ++k) e[k] = hn::Add(e[k], step[k]);
      }
    }
    if (!hn::AllFalse(d, won)) ++tile_.recordCount;
  }

  Tile& tile_;
  Boxes boxes_;
  alignas(64) RowStarts starts_[4];  // at pixel centres, of all planes
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
