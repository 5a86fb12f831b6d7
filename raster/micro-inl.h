// Triangles whose boxes are at most 3 × 3 pixels, a vector of triangles at a time. Definition: drawTriangle in
// visibility.cpp.
#if defined(LIMN_RASTER_MICRO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_MICRO_INL_H_
#undef LIMN_RASTER_MICRO_INL_H_
#else
#define LIMN_RASTER_MICRO_INL_H_
#endif

#include <bit>

#include "raster/cluster-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// Micro triangles and the depths of their corners.
struct MicroQueue : TriangleQueue {
  static constexpr std::int32_t kReach = 2;  ///< their last pixels are at most this far from the first
  alignas(64) float depth[3][kSize];
};

class Micro {
 public:
  explicit Micro(Tile& tile) : tile_(tile) {}

  void draw(const ClusterInTile& cluster, const MicroQueue& queue) {
    for (std::size_t i = 0; i < queue.count; i += kLanes) {
      cluster_ = &cluster, queue_ = &queue, first_ = i;
      drawVector();
    }
  }

 private:
  HWY_INLINE void drawVector() {
    const I d;
    const F f;
    const TriangleVector t(tile_, *queue_, first_);
    const MI mine = hn::FirstN(d, queue_->count - first_);
    const VI wide = hn::IfThenElseZero(mine, hn::Sub(t.px.last, t.px.first));
    const VI high = hn::IfThenElseZero(mine, hn::Sub(t.py.last, t.py.first));
    const std::int32_t columns = hn::GetLane(hn::MaxOfLanes(d, wide)),
                       rows = hn::GetLane(hn::MaxOfLanes(d, high));
    const VF z0 = hn::LoadU(f, queue_->depth[0] + first_);
    const VF d1 = hn::Sub(hn::LoadU(f, queue_->depth[1] + first_), z0),
             d2 = hn::Sub(hn::LoadU(f, queue_->depth[2] + first_), z0);
    const VF slopeX = hn::Sub(hn::Mul(d1, t.x1), hn::Mul(d2, t.x2)),
             slopeY = hn::Sub(hn::Mul(d2, t.y2), hn::Mul(d1, t.y1));
    hn::Store(t.x1, f, x1_), hn::Store(t.x2, f, x2_), hn::Store(t.y1, f, y1_), hn::Store(t.y2, f, y2_);
    hn::Store(hn::Set(d, -1), d, id_);
    hn::Store(hn::Sub(t.px.first, hn::Set(d, tile_.left)), d, left_);
    hn::Store(hn::Sub(t.py.first, hn::Set(d, tile_.top)), d, top_);
    for (std::size_t s = 0; s < tile_.context->samples.size(); ++s) {
      const SamplePosition at = tile_.context->samples[s];
      const VI ox = hn::Sub(hn::Add(hn::ShiftLeft<kSubpixelBits>(t.px.first), hn::Set(d, at.x)), t.x[0]);
      const VI oy = hn::Sub(hn::Add(hn::ShiftLeft<kSubpixelBits>(t.py.first), hn::Set(d, at.y)), t.y[0]);
      VI e[3];
      for (int k = 0; k < 3; ++k) e[k] = t.edgeAt(k, at);
      for (std::int32_t j = 0; j <= rows; ++j) {
        const VI dy = hn::Add(oy, hn::Set(d, j * kSubpixels));
        const VF zRow = hn::Add(z0, hn::Mul(slopeY, hn::ConvertTo(f, dy)));
        const MI inRow = hn::And(mine, atMost(hn::Set(d, j), high));
        for (std::int32_t c = 0; c <= columns; ++c) {
          VI worst = hn::Zero(d);
          for (int k = 0; k < 3; ++k)
            worst = hn::Or(worst, hn::Sub(hn::Add(e[k], hn::Mul(t.edgeX[k], hn::Set(d, j * kSubpixels))),
                                          hn::Mul(t.edgeY[k], hn::Set(d, c * kSubpixels))));
          const MI covered =
              hn::And(hn::And(inRow, atMost(hn::Set(d, c), wide)), hn::Gt(worst, hn::Set(d, -1)));
          if (hn::AllFalse(d, covered)) continue;
          const VI dx = hn::Add(ox, hn::Set(d, c * kSubpixels));
          write(covered, hn::Add(zRow, hn::Mul(slopeX, hn::ConvertTo(f, dx))), static_cast<int>(s), c, j);
        }
      }
    }
  }

  // The covered triangles' pixels at (c, j) of their boxes.
  HWY_INLINE void write(MI covered, VF z, int sample, std::int32_t c, std::int32_t j) {
    alignas(64) float depth[kLanes];
    hn::Store(z, F(), depth);
    for (unsigned left = bitsOf(covered); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const int x = left_[lane] + c, y = top_[lane] + j;
      const std::size_t o = tile_.offset(sample, x, y);
      if (depth[lane] < tile_.depth[o]) continue;
      if (depth[lane] == tile_.depth[o] && !winsTie(lane, tile_.ids[o])) continue;
      if (id_[lane] < 0) id_[lane] = static_cast<std::int32_t>(keep(lane));
      tile_.depth[o] = depth[lane];
      tile_.ids[o] = static_cast<std::uint32_t>(id_[lane]);
      setPoint(tile_.records[tile_.ids[o]], x, y);
    }
  }

  std::uint32_t tagOf(std::size_t lane) const {
    return static_cast<std::uint32_t>(queue_->tag[first_ + lane]);
  }

  bool winsTie(std::size_t lane, std::uint32_t other) const {
    if (other == kNoRecord) return true;
    const std::uint32_t triangle =
        cluster_->cluster->firstTriangle + (tagOf(lane) & (kClusterTriangles - 1U));
    return cluster_->batch->order(triangle) < tile_.orderOf(tile_.records[other]);
  }

  // Keeps a triangle's record and returns its number.
  HWY_INLINE std::uint32_t keep(std::size_t lane) {
    cluster_->setRecord(tagOf(lane), x1_[lane], x2_[lane], y1_[lane], y2_[lane],
                        tile_.records[tile_.recordCount]);
    if (tile_.keepsCorners())
      for (int k = 0; k < 3; ++k)
        tile_.corners[tile_.recordCount].x[k] = queue_->x[k][first_ + lane],
        tile_.corners[tile_.recordCount].y[k] = queue_->y[k][first_ + lane];
    return tile_.recordCount++;
  }

  // Tile::setPoint.
  HWY_INLINE void setPoint(const Record& record, int x, int y) {
    const F4 f;
    const std::int32_t px = (tile_.left + x) * kSubpixels + kOneSample[0].x,
                       py = (tile_.top + y) * kSubpixels + kOneSample[0].y;
    const auto dx = hn::Set(f, static_cast<float>(px - record.x0)),
               dy = hn::Set(f, static_cast<float>(py - record.y0));
    const auto start = hn::Add(hn::Load(f, record.origin), hn::Mul(hn::Load(f, record.slopeY), dy));
    alignas(16) float value[4];
    hn::Store(hn::Add(start, hn::Mul(hn::Load(f, record.slopeX), dx)), f, value);
    const std::size_t o = tile_.offset(0, x, y);
    for (std::size_t i = 0; i < 3; ++i) tile_.normal[i][o] = value[i];
    if (tile_.context->samples.size() > 1) tile_.centerDepth[o] = value[3];
  }

  Tile& tile_;
  const ClusterInTile* cluster_ = nullptr;
  const MicroQueue* queue_ = nullptr;
  std::size_t first_ = 0;
  // Of the vector of triangles: their plane bases, first pixels, and records, or -1.
  alignas(64) float x1_[kLanes], x2_[kLanes], y1_[kLanes], y2_[kLanes];
  alignas(64) std::int32_t left_[kLanes], top_[kLanes], id_[kLanes];
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
