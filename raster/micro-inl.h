// Triangles whose boxes are at most 4 × 4 pixels of one sample or 3 × 3 of several, a vector of triangles at a time.
// Definition: drawTriangle in visibility.cpp.
#if defined(LIMN_RASTER_MICRO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_MICRO_INL_H_
#undef LIMN_RASTER_MICRO_INL_H_
#else
#define LIMN_RASTER_MICRO_INL_H_
#endif

#include <algorithm>
#include <bit>

#include "raster/cluster-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// Micro triangles and the depths of their corners.
struct MicroQueue : TriangleQueue {
  /// Their last pixels are at most this far from the first. Larger ones are drawn sooner one by one, and with several
  /// samples the more so, since what they cover here is written sample by sample.
  static constexpr std::int32_t kReach = kLanes == 16 ? 3 : 2, kReachOfSamples = 2;
  alignas(64) float depth[3][kSize];
};

class Micro {
 public:
  explicit Micro(Tile& tile) : tile_(tile), severalSamples_(tile.hasSeveralSamples()) {}

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
    const VI left = hn::Sub(t.px.first, hn::Set(d, tile_.left)),
             top = hn::Sub(t.py.first, hn::Set(d, tile_.top));
    hn::Store(left, d, left_), hn::Store(top, d, top_);
    hn::Store(centerFrom(t.px.first, t.x[0]), f, centerX_);
    hn::Store(centerFrom(t.py.first, t.y[0]), f, centerY_);
    if (severalSamples_) setCenterEdges(t, left, top);
    MI seen = hn::FirstN(d, 0);
    listed_ = 0;
    const VI ramp = hn::Iota(d, 0);
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
          const VI dx = hn::Add(ox, hn::Set(d, c * kSubpixels));
          const VF z = hn::Add(zRow, hn::Mul(slopeX, hn::ConvertTo(f, dx)));
          const auto place =
              static_cast<std::int32_t>(s << kSampleShift) | j << kRowShift | c << kColumnShift;
          hn::StoreU(compressed(z, covered), f, depth_ + listed_);
          hn::StoreU(compressed(hn::Or(ramp, hn::Set(d, place)), covered), d, place_ + listed_);
          listed_ += hn::CountTrue(d, covered);
          seen = hn::Or(seen, covered);
        }
      }
    }
    for (unsigned lanes = bitsOf(seen); lanes != 0; lanes &= lanes - 1)
      keep(static_cast<std::size_t>(std::countr_zero(lanes)));
    for (std::size_t i = 0; i < listed_; ++i) write(i);
  }

  HWY_INLINE void setCenterEdges(const TriangleVector& t, VI left, VI top) {
    const I d;
    for (int k = 0; k < 3; ++k) {
      const VI stepX = hn::Neg(t.edgeY[k]), stepY = t.edgeX[k];
      const VI first = hn::ShiftRight<kSubpixelBits>(t.edgeAt(k, kOneSample[0]));
      hn::Store(hn::Sub(first, hn::Add(hn::Mul(left, stepX), hn::Mul(top, stepY))), d, edge_[k]);
      hn::Store(stepX, d, edgeStepX_[k]), hn::Store(stepY, d, edgeStepY_[k]);
    }
  }

  // How far the first pixels' centres are from the anchors.
  HWY_INLINE static VF centerFrom(VI pixel, VI anchor) {
    const VI center = hn::Add(hn::ShiftLeft<kSubpixelBits>(pixel), hn::Set(I(), kOneSample[0].x));
    return hn::ConvertTo(F(), hn::Sub(center, anchor));
  }

  // One covered sample of the list.
  HWY_INLINE void write(std::size_t i) {
    const auto place = static_cast<std::uint32_t>(place_[i]);
    const std::size_t lane = place & (kLanes - 1), sample = place >> kSampleShift;
    const std::uint32_t row = (place >> kRowShift) & 3U, column = (place >> kColumnShift) & 3U;
    const std::size_t pixel =
        tile_.pixelOffset(left_[lane] + static_cast<int>(column), top_[lane] + static_cast<int>(row));
    const std::size_t o =
        severalSamples_ ? (sample / kGroup * tile_.plane + pixel) * kGroup + sample % kGroup : pixel;
    const float depth = depth_[i];
    if (depth < tile_.depth[o]) return;
    if (depth == tile_.depth[o] && !winsTie(lane, tile_.ids[o])) return;
    tile_.depth[o] = depth;
    tile_.ids[o] = id_[lane];
    // Tile::setPoint.
    const F4 f;
    const Record& record = tile_.records[id_[lane]];
    const auto dx = hn::Set(f, centerX_[lane] + static_cast<float>(column * kSubpixels)),
               dy = hn::Set(f, centerY_[lane] + static_cast<float>(row * kSubpixels));
    const auto start = hn::Add(hn::Load(f, record.origin), hn::Mul(hn::Load(f, record.slopeY), dy));
    const auto values = hn::Add(start, hn::Mul(hn::Load(f, record.slopeX), dx));
    if (severalSamples_) return hn::Store(values, f, &tile_.centers[4 * pixel]);
    alignas(16) float value[4];
    hn::Store(values, f, value);
    for (std::size_t k = 0; k < 3; ++k) tile_.normal[k][pixel] = value[k];
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

  // Keeps the record of a triangle that covers a sample.
  HWY_INLINE void keep(std::size_t lane) {
    const std::uint32_t id = tile_.recordCount;
    id_[lane] = id;
    cluster_->prepareRecord(tile_, tagOf(lane), x1_[lane], x2_[lane], y1_[lane], y2_[lane]);
    ++tile_.recordCount;
    if (!severalSamples_) return;
    CenterEdges& edges = tile_.centerEdges[id];
    for (int k = 0; k < 3; ++k)
      edges.value[k] = edge_[k][lane], edges.stepX[k] = edgeStepX_[k][lane],
      edges.stepY[k] = edgeStepY_[k][lane];
    edges.value[3] = edges.stepX[3] = edges.stepY[3] = 0;
  }

  // A listed sample's place: its triangle's lane, and where in the triangle's box it is.
  static constexpr int kColumnShift = 4, kRowShift = 6, kSampleShift = 8;
  static constexpr std::size_t kOneSampled = (MicroQueue::kReach + 1) * (MicroQueue::kReach + 1);
  static constexpr std::size_t kSampled =
      (MicroQueue::kReachOfSamples + 1) * (MicroQueue::kReachOfSamples + 1) * kMaxSamples;
  static constexpr std::size_t kMost = std::max(kOneSampled, kSampled);

  Tile& tile_;
  bool severalSamples_;
  const ClusterInTile* cluster_ = nullptr;
  const MicroQueue* queue_ = nullptr;
  std::size_t first_ = 0;
  // Of the vector of triangles: their plane bases, records, their first pixels in the tile, and how far
  // these pixels' centres are from where the planes are anchored.
  alignas(64) float x1_[kLanes], x2_[kLanes], y1_[kLanes], y2_[kLanes], centerX_[kLanes], centerY_[kLanes];
  alignas(64) std::int32_t left_[kLanes], top_[kLanes];
  alignas(64) std::int32_t edge_[3][kLanes], edgeStepX_[3][kLanes], edgeStepY_[3][kLanes];  // CenterEdges
  std::uint32_t id_[kLanes];
  // The samples that they cover.
  std::size_t listed_ = 0;
  alignas(64) float depth_[(kMost + 1) * kLanes];
  alignas(64) std::int32_t place_[(kMost + 1) * kLanes];
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
