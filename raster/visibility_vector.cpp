// Visibility of a tile, a vector at a time. Definition: visibility.cpp.
//
// Based on: S. Laine, T. Karras, "High-performance software rasterization on GPUs", 2011 (size classes);
// M. Abrash, "Rasterization on Larrabee", 2009.
// Differs in: a cluster's triangles are culled a vector at a time; of what is left, boxes of at most 4 × 4 pixels are
// drawn a vector of triangles at a time, all others a vector of pixels at a time, column by column of that width.
#include "raster/setup.h"
#include "raster/surface.h"
#include "raster/vector_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility_vector.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "raster/micro-inl.h"
#include "raster/multisample-inl.h"
#include "raster/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
void resolveVisibilityVector(Tile& tile) {
  resolveVisibility(tile);
}
#else
constexpr std::int32_t kMaxTile = 128;
constexpr std::int32_t kSmall = (1 << 15) - 1024;  // edge functions of smaller boxes fit 32 bits

// Values of a cluster's vertices by their numbers.
class Lookup {
 public:
  explicit Lookup(VI index) : index_(index) {
    const I d;
    if constexpr (kLanes == 16) {
      low_ = hn::And(index, hn::Set(d, 15));
      odd_ = hn::Ne(hn::And(index, hn::Set(d, 16)), hn::Zero(d));
      upper_ = hn::Gt(index, hn::Set(d, 31));
    }
  }
  template <class D>
  hn::Vec<D> operator()(D d, const hn::TFromD<D>* table) const {
    if constexpr (kLanes == 16) {
      const auto at = hn::IndicesFromVec(d, low_);
      const auto odd = hn::RebindMask(d, odd_), upper = hn::RebindMask(d, upper_);
      const auto a = hn::IfThenElse(odd, hn::TableLookupLanes(hn::Load(d, table + 16), at),
                                    hn::TableLookupLanes(hn::Load(d, table), at));
      const auto b = hn::IfThenElse(odd, hn::TableLookupLanes(hn::Load(d, table + 48), at),
                                    hn::TableLookupLanes(hn::Load(d, table + 32), at));
      return hn::IfThenElse(upper, b, a);
    } else {
      return hn::GatherIndex(d, table, index_);
    }
  }

 private:
  VI index_;
  VI low_ = hn::Zero(I());
  MI odd_ = hn::FirstN(I(), 0), upper_ = odd_;
};

class Visibility {
 public:
  explicit Visibility(Tile& tile)
      : tile_(tile), context_(*tile.context), micro_(tile), rows_(tile), multisample_(tile) {}

  void cluster(std::uint32_t entry) {
    const VisibleCluster& visible = context_.front.cluster(tile_.clusters[entry]);
    const Batch& batch = context_.batches[visible.batch];
    const Cluster& cluster = batch.set->clusters[visible.cluster];
    cluster_ = {&batch, &cluster, &tile_.blocks[entry], entry * kClusterTriangles};
    const Material& material = context_.frame.materials[cluster.material];
    tile_.clock.lap(tile_.statistics.visibilityMs);
    context_.kernels.transformCluster(batch, cluster, context_.map, tile_.blocks[entry]);
    if (tile_.texturedMaterial != nullptr)
      setTexcoords(batch, cluster, material, context_.map.perspective, tile_.blocks[entry]);
    tile_.clock.lap(tile_.statistics.transformMs);
    if (material.alphaMode == AlphaMode::kMask) return drawClusterScalar(tile_, entry);
    tile_.reserveRecords(kClusterTriangles);
    microQueue_.count = rowQueue_.count = longCount_ = 0;
    minX_ = minY_ = hn::Set(I(), kMaxTile), maxX_ = maxY_ = hn::Set(I(), -1);
    for (std::size_t t = 0; t < cluster.triangleCount; t += kLanes) sort(t, material.doubleSided);
    touchQueued();
    tile_.clock.lap(tile_.statistics.setupMs);
    micro_.draw(cluster_, microQueue_);
    if (tile_.hasSeveralSamples())
      multisample_.draw(cluster_, rowQueue_);
    else
      rows_.draw(cluster_, rowQueue_);
    for (std::size_t i = 0; i < longCount_; ++i) drawLong(long_[i]);
  }

  void loose(std::uint32_t item) {
    const LooseTriangle& t = context_.front.loose(item);
    const Cluster& cluster = context_.batches[t.ref.batch].set->clusters[t.ref.cluster];
    if (context_.frame.materials[cluster.material].alphaMode == AlphaMode::kMask)
      return drawLooseScalar(tile_, item);
    TriangleSetup setup;
    if (!setLoose(tile_, item, setup)) return;
    tile_.statistics.trianglesDrawn += isFirstTile(tile_, setup.corners) ? 1 : 0;
    tile_.reserveRecords(1);
    tile_.records[tile_.recordCount] = setup.record;
    drawAlone(setup.corners, setup.pixels);
  }

 private:
  // Triangles [t, t + kLanes) of a cluster on their way into the queues.
  struct Candidates {
    std::size_t t;
    Lookup a, b, c;             // the values of their corners
    VI ax, ay, bx, by, cx, cy;  // corners as submitted
    VI extent;                  // the longer side of the box of corners
    PixelRange x, y;            // of the tile's pixels with samples in that box
    VI ux, uy, vx, vy, area;    // edges from the first corner, twice the signed area
    MI negative, positive;      // by that area
    MI live;                    // may cover samples of the tile, and neither culled nor queued yet

    HWY_INLINE Candidates(const Tile& tile, const ClusterInTile& cluster, std::size_t first)
        : t(first), a(lookup(cluster, 0, t)), b(lookup(cluster, 1, t)), c(lookup(cluster, 2, t)) {
      const I d;
      const VertexBlock& block = *cluster.block;
      ax = a(d, block.x), ay = a(d, block.y);
      bx = b(d, block.x), by = b(d, block.y);
      cx = c(d, block.x), cy = c(d, block.y);
      const VI minX = min3(ax, bx, cx), maxX = max3(ax, bx, cx);
      const VI minY = min3(ay, by, cy), maxY = max3(ay, by, cy);
      extent = hn::Max(hn::Sub(maxX, minX), hn::Sub(maxY, minY));
      x = pixelsOf(tile, minX, maxX, tile.left, tile.width);
      y = pixelsOf(tile, minY, maxY, tile.top, tile.height);
      live = hn::And(hn::FirstN(d, cluster.cluster->triangleCount - t),
                     hn::And(atMost(x.first, x.last), atMost(y.first, y.last)));
    }
    HWY_INLINE void setAreas() {
      const I d;
      ux = hn::Sub(bx, ax), uy = hn::Sub(by, ay), vx = hn::Sub(cx, ax), vy = hn::Sub(cy, ay);
      area = hn::Sub(hn::Mul(ux, vy), hn::Mul(vx, uy));
      negative = hn::Lt(area, hn::Zero(d)), positive = hn::Gt(area, hn::Zero(d));
    }
    HWY_INLINE bool none() const { return hn::AllFalse(I(), live); }

   private:
    HWY_INLINE static Lookup lookup(const ClusterInTile& cluster, std::size_t corner, std::size_t t) {
      const std::uint8_t* const numbers = cluster.batch->set->corners[corner].data();
      return Lookup(hn::PromoteTo(I(), hn::LoadU(U8(), numbers + cluster.cluster->firstTriangle + t)));
    }
  };

  // Triangles [t, t + kLanes) of the cluster: culls them and queues the others by size.
  HWY_INLINE void sort(std::size_t t, bool doubleSided) {
    const I d;
    Candidates c(tile_, cluster_, t);
    c.live = hn::And(c.live, notReplaced(cluster_.cluster->firstTriangle + t));
    if (c.none()) return;
    const MI small = hn::Lt(c.extent, hn::Set(d, kSmall)), large = hn::AndNot(small, c.live);
    if (!hn::AllFalse(d, large)) sortLarge(t, large, doubleSided);
    c.setAreas();
    const MI back = cluster_.batch->mirrored ? c.negative : c.positive,
             front = cluster_.batch->mirrored ? c.positive : c.negative;
    c.live = hn::And(hn::And(c.live, small), doubleSided ? hn::Or(front, back) : front);
    if (c.none()) return;
    countAndBound(c);
    const VI tag = tagsOf(c, back);
    queueSlivers(c, tag);
    queueBySize(c, tag);
  }

  // Statistics, and the pixels that touchQueued() is to clear.
  HWY_INLINE void countAndBound(const Candidates& c) {
    const I d;
    const MI isFirst = hn::And(atLeast(hn::Max(c.x.begin, hn::Zero(d)), hn::Set(d, tile_.left)),
                               atLeast(hn::Max(c.y.begin, hn::Zero(d)), hn::Set(d, tile_.top)));
    tile_.statistics.trianglesDrawn += hn::CountTrue(d, hn::And(c.live, isFirst));
    const VI left = hn::Set(d, tile_.left), top = hn::Set(d, tile_.top);
    const auto where = [&](VI v, VI other) HWY_ATTR { return hn::IfThenElse(c.live, v, other); };
    minX_ = hn::Min(minX_, where(hn::Sub(c.x.first, left), minX_));
    maxX_ = hn::Max(maxX_, where(hn::Sub(c.x.last, left), maxX_));
    minY_ = hn::Min(minY_, where(hn::Sub(c.y.first, top), minY_));
    maxY_ = hn::Max(maxY_, where(hn::Sub(c.y.last, top), maxY_));
  }

  HWY_INLINE static VI tagsOf(const Candidates& c, MI back) {
    const I d;
    VI tag = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(c.t)));
    tag = hn::Or(tag, hn::And(hn::VecFromMask(d, c.negative), hn::Set(d, kSwapped)));
    return hn::Or(tag, hn::And(hn::VecFromMask(d, back), hn::Set(d, kBack)));
  }

  HWY_INLINE void queueSlivers(Candidates& c, VI tag) {
    const I d;
    const MI sliver = hn::And(slivers(c.area, c.ux, c.uy, c.vx, c.vy), c.live);
    if (hn::AllFalse(d, sliver)) return;
    alignas(64) std::int32_t tags[kLanes];
    hn::Store(tag, d, tags);
    for (unsigned rest = bitsOf(sliver); rest != 0; rest &= rest - 1)
      long_[longCount_++] = static_cast<std::uint32_t>(tags[std::countr_zero(rest)]);
    c.live = hn::AndNot(sliver, c.live);
  }

  // Micro triangles with their corners' depths.
  HWY_INLINE void queueBySize(const Candidates& c, VI tag) {
    const I d;
    const F f;
    const VI reach = hn::Set(d, tile_.hasSeveralSamples() ? MicroQueue::kReachOfSamples : MicroQueue::kReach);
    const MI tiny =
        hn::And(atMost(hn::Sub(c.x.last, c.x.first), reach), atMost(hn::Sub(c.y.last, c.y.first), reach));
    const MI rows = hn::AndNot(tiny, c.live), micro = hn::And(tiny, c.live);
    if (!hn::AllFalse(d, rows)) enqueue(c, tag, rows, rowQueue_);
    if (hn::AllFalse(d, micro)) return;
    const float* const depth = cluster_.block->depth;
    const VF az = c.a(f, depth), bz = c.b(f, depth), cz = c.c(f, depth);
    const MF negativeF = hn::RebindMask(f, c.negative);
    const auto putDepth = [&](int k, VF v) {
      hn::StoreU(compressed(v, micro), f, microQueue_.depth[k] + microQueue_.count);
    };
    putDepth(0, az);
    putDepth(1, hn::IfThenElse(negativeF, cz, bz));
    putDepth(2, hn::IfThenElse(negativeF, bz, cz));
    enqueue(c, tag, micro, microQueue_);
  }

  HWY_INLINE static void enqueue(const Candidates& c, VI tag, MI which, TriangleQueue& queue) {
    const I d;
    const std::size_t n = queue.count;
    const auto put = [&](VI v, std::int32_t* to) { hn::StoreU(compressed(v, which), d, to + n); };
    put(c.ax, queue.x[0]), put(c.ay, queue.y[0]);
    put(hn::IfThenElse(c.negative, c.cx, c.bx), queue.x[1]);
    put(hn::IfThenElse(c.negative, c.cy, c.by), queue.y[1]);
    put(hn::IfThenElse(c.negative, c.bx, c.cx), queue.x[2]);
    put(hn::IfThenElse(c.negative, c.by, c.cy), queue.y[2]);
    put(tag, queue.tag);
    queue.count += hn::CountTrue(d, which);
  }

  HWY_INLINE void touchQueued() {
    const I d;
    const std::int32_t last = hn::GetLane(hn::MaxOfLanes(d, maxX_));
    if (last < 0) return;
    tile_.touch(hn::GetLane(hn::MinOfLanes(d, minX_)), hn::GetLane(hn::MinOfLanes(d, minY_)), last + 1,
                hn::GetLane(hn::MaxOfLanes(d, maxY_)) + 1);
  }

  // PlaneBasis::setSliver's condition, or nearly so: what it holds for is left to that.
  HWY_INLINE static MI slivers(VI area, VI ux, VI uy, VI vx, VI vy) {
    const I d;
    const F f;
    const auto square = [&](VI x, VI y) {
      const VF a = hn::ConvertTo(f, x), b = hn::ConvertTo(f, y);
      return hn::Add(hn::Mul(a, a), hn::Mul(b, b));
    };
    const VF longest = hn::Max(square(ux, uy), square(vx, vy));
    return hn::RebindMask(d, hn::Le(hn::Mul(hn::ConvertTo(f, hn::Abs(area)), hn::Set(f, 4000.0F)), longest));
  }

  MI notReplaced(std::size_t first) const {
    const I d;
    if (cluster_.batch->isStream || cluster_.batch->draw->replaced.empty()) return hn::FirstN(d, kLanes);
    const std::uint32_t replaced = cluster_.batch->replacedFrom(static_cast<std::uint32_t>(first));
    return hn::Not(lanesOf(replaced));
  }

  void sortLarge(std::size_t t, MI lanes, bool doubleSided) {
    alignas(64) std::int32_t large[kLanes];
    hn::Store(hn::VecFromMask(I(), lanes), I(), large);
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (large[i] == 0) continue;
      const auto triangle = static_cast<std::int32_t>(t + i);
      const Corners c = cluster_.cornersOf(static_cast<std::uint32_t>(triangle));
      const std::int64_t area = signedArea(c);
      const bool back = facesAway(area, cluster_.batch->mirrored);
      if (area == 0 || (back && !doubleSided)) continue;
      tile_.statistics.trianglesDrawn += isFirstTile(tile_, c) ? 1 : 0;
      long_[longCount_++] =
          static_cast<std::uint32_t>(triangle | (area < 0 ? kSwapped : 0) | (back ? kBack : 0));
    }
  }

  // Triangles of 64-bit edge functions, and slivers.
  void drawLong(std::uint32_t tag) {
    const Corners c = cluster_.cornersOf(tag);
    const PlaneBasis basis(c);
    tile_.reserveRecords(1);
    cluster_.prepareRecord(tile_, tag, basis.x1, basis.x2, basis.y1, basis.y2);
    drawAlone(c, pixelsOf(tile_, c));
  }

  // Draws the record that is next to be kept.
  void drawAlone(const Corners& c, const PixelBox& p) {
    tile_.touch(p.x0, p.y0, p.x1, p.y1);
    if (tile_.hasSeveralSamples())
      multisample_.draw(c, p.x0, p.y0, p.x1, p.y1);
    else
      rows_.draw(c, p.x0, p.y0, p.x1, p.y1);
  }

  Tile& tile_;
  const FrameContext& context_;
  ClusterInTile cluster_;
  Micro micro_;
  Rows rows_;
  Multisample multisample_;
  MicroQueue microQueue_;
  TriangleQueue rowQueue_;
  VI minX_, minY_, maxX_, maxY_;  // of the pixels of queued triangles
  std::uint32_t long_[kClusterTriangles];
  std::size_t longCount_ = 0;
};

void resolveVisibilityVector(Tile& tile) {
  Visibility visibility(tile);
  for (std::uint32_t entry = 0; entry < tile.clusters.size(); ++entry) visibility.cluster(entry);
  for (const std::uint32_t item : tile.loose) visibility.loose(item);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::raster {
HWY_EXPORT(resolveVisibilityVector);
namespace {
void resolve(Tile& tile) {
  HWY_DYNAMIC_DISPATCH(resolveVisibilityVector)(tile);
}
}  // namespace
void setVisibilityKernel(Kernels& kernels) {
  kernels.resolveVisibility = resolve;
}
}  // namespace limn::raster
#endif
