// Visibility of a tile, a vector at a time. Definition: visibility.cpp.
//
// Based on: S. Laine, T. Karras, "High-performance software rasterization on GPUs", 2011 (size classes);
// M. Abrash, "Rasterization on Larrabee", 2009.
// Differs in: a cluster's triangles are culled a vector at a time; of what is left, boxes of at most 3 × 3 pixels are
// drawn a vector of triangles at a time, all others a vector of pixels at a time, column by column of that width.
#include "raster/setup.h"
#include "raster/surface.h"
#include "raster/vector_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility_vector.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
void resolveVisibilityVector(Tile& tile) {
  resolveVisibility(tile);
}
#else
constexpr std::int32_t kSmall = 1 << 15;  // boxes below it have areas of 32 bits
constexpr std::int32_t kMicro = 2;        // a micro triangle's last pixel is at most this far from its first

// A triangle of the cluster in the queues: its number and how its corners were turned.
constexpr std::int32_t kSwapped = 128, kBack = 256;

struct MicroQueue {
  static constexpr std::size_t kSize = kClusterTriangles + 16;
  alignas(64) std::int32_t x[3][kSize], y[3][kSize];
  alignas(64) float depth[3][kSize];
  alignas(64) std::int32_t triangle[kSize];
  std::size_t count = 0;
};

struct RowQueue {
  alignas(64) std::int32_t triangle[kClusterTriangles + 16];
  std::size_t count = 0;
};

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

// First and last pixel (in the window) of a range of sub-pixels that hold a sample in it, clipped to the tile.
struct PixelRange {
  VI first, last;
  VI begin;  // first, not clipped
};

inline PixelRange pixelsOf(const Tile& tile, VI low, VI high, int from, int size) {
  const I d;
  const VI begin =
      hn::ShiftRight<kSubpixelBits>(hn::Add(low, hn::Set(d, kSubpixels - 1 - tile.sampleRange.high)));
  const VI last = hn::ShiftRight<kSubpixelBits>(hn::Sub(high, hn::Set(d, tile.sampleRange.low)));
  return {hn::Max(begin, hn::Set(d, from)), hn::Min(last, hn::Set(d, from + size - 1)), begin};
}

inline VI min3(VI a, VI b, VI c) {
  return hn::Min(hn::Min(a, b), c);
}
inline VI max3(VI a, VI b, VI c) {
  return hn::Max(hn::Max(a, b), c);
}

class Visibility {
 public:
  explicit Visibility(Tile& tile) : tile_(tile), context_(*tile.context) {}

  void cluster(std::uint32_t entry) {
    const VisibleCluster& visible = context_.front.cluster(tile_.clusters[entry]);
    batch_ = &context_.batches[visible.batch];
    cluster_ = &batch_->set->clusters[visible.cluster];
    block_ = &tile_.blocks[entry];
    source_ = entry * kClusterTriangles;
    const Material& material = context_.frame.materials[cluster_->material];
    context_.kernels.transformCluster(*batch_, *cluster_, context_.map, tile_.blocks[entry]);
    if (material.alphaMode == AlphaMode::kMask) return drawClusterScalar(tile_, entry);
    tile_.reserveRecords(kClusterTriangles);
    micro_.count = rows_.count = 0;
    for (std::size_t t = 0; t < cluster_->triangleCount; t += kLanes) sort(t, material.doubleSided);
    for (std::size_t i = 0; i < micro_.count; i += kLanes) drawMicro(i);
    for (std::size_t i = 0; i < rows_.count; ++i) drawRow(static_cast<std::uint32_t>(rows_.triangle[i]));
  }

  void loose(std::uint32_t item) {
    const LooseTriangle& t = context_.front.loose(item);
    const Cluster& cluster = context_.batches[t.ref.batch].set->clusters[t.ref.cluster];
    if (context_.frame.materials[cluster.material].alphaMode == AlphaMode::kMask)
      return drawLooseScalar(tile_, item);
    TriangleSetup setup;
    if (!setLoose(tile_, item, setup)) return;
    countFirst(setup.corners);
    tile_.reserveRecords(1);
    tile_.records[tile_.recordCount] = setup.record;
    if (tile_.keepsCorners()) tile_.corners[tile_.recordCount] = setup.corners;
    drawPixels(setup.corners, setup.x0, setup.y0, setup.x1, setup.y1);
  }

 private:
  // Triangles [t, t + kLanes) of the cluster: culls them and queues the others by size.
  HWY_INLINE void sort(std::size_t t, bool doubleSided) {
    const I d;
    const F f;
    const std::size_t first = cluster_->firstTriangle + t;
    const auto& corners = batch_->set->corners;
    const auto local = [&](int k) {
      return Lookup(hn::PromoteTo(d, hn::LoadU(U8(), corners[static_cast<std::size_t>(k)].data() + first)));
    };
    const Lookup a = local(0), b = local(1), c = local(2);
    const VI ax = a(d, block_->x), ay = a(d, block_->y), bx = b(d, block_->x), by = b(d, block_->y);
    const VI cx = c(d, block_->x), cy = c(d, block_->y);
    const VI minX = min3(ax, bx, cx), maxX = max3(ax, bx, cx), minY = min3(ay, by, cy),
             maxY = max3(ay, by, cy);
    const PixelRange x = pixelsOf(tile_, minX, maxX, tile_.left, tile_.width);
    const PixelRange y = pixelsOf(tile_, minY, maxY, tile_.top, tile_.height);
    MI live = hn::And(hn::FirstN(d, cluster_->triangleCount - t),
                      hn::And(atMost(x.first, x.last), atMost(y.first, y.last)));
    live = hn::And(live, notReplaced(first));
    if (hn::AllFalse(d, live)) return;

    const VI extent = hn::Max(hn::Sub(maxX, minX), hn::Sub(maxY, minY));
    const MI small = hn::Lt(extent, hn::Set(d, kSmall));
    const MI large = hn::AndNot(small, live);
    if (!hn::AllFalse(d, large)) sortLarge(t, large, doubleSided);

    const VI ux = hn::Sub(bx, ax), uy = hn::Sub(by, ay), vx = hn::Sub(cx, ax), vy = hn::Sub(cy, ay);
    const VI area = hn::Sub(hn::Mul(ux, vy), hn::Mul(vx, uy));
    const MI negative = hn::Lt(area, hn::Zero(d)), positive = hn::Gt(area, hn::Zero(d));
    const MI back = batch_->mirrored ? negative : positive, front = batch_->mirrored ? positive : negative;
    live = hn::And(hn::And(live, small), doubleSided ? hn::Or(front, back) : front);
    if (hn::AllFalse(d, live)) return;
    const MI isFirst = hn::And(atLeast(hn::Max(x.begin, hn::Zero(d)), hn::Set(d, tile_.left)),
                               atLeast(hn::Max(y.begin, hn::Zero(d)), hn::Set(d, tile_.top)));
    tile_.statistics.trianglesDrawn += hn::CountTrue(d, hn::And(live, isFirst));

    VI tag = hn::Iota(d, static_cast<std::int32_t>(t));
    tag = hn::Or(tag, hn::And(hn::VecFromMask(d, negative), hn::Set(d, kSwapped)));
    tag = hn::Or(tag, hn::And(hn::VecFromMask(d, back), hn::Set(d, kBack)));
    const MI tiny = hn::And(atMost(hn::Sub(x.last, x.first), hn::Set(d, kMicro)),
                            atMost(hn::Sub(y.last, y.first), hn::Set(d, kMicro)));
    const MI micro = hn::And(live, hn::AndNot(slivers(area, ux, uy, vx, vy), tiny));
    const MI rows = hn::AndNot(micro, live);
    if (!hn::AllFalse(d, rows)) {
      hn::StoreU(hn::Compress(tag, rows), d, rows_.triangle + rows_.count);
      rows_.count += hn::CountTrue(d, rows);
    }
    if (hn::AllFalse(d, micro)) return;
    // Corners in the order that makes the area positive.
    const VF az = a(f, block_->depth), bz = b(f, block_->depth), cz = c(f, block_->depth);
    const auto negativeF = hn::RebindMask(f, negative);
    const auto microF = hn::RebindMask(f, micro);
    const std::size_t n = micro_.count;
    const auto put = [&](VI v, std::int32_t* to) { hn::StoreU(hn::Compress(v, micro), d, to + n); };
    const auto putF = [&](VF v, float* to) { hn::StoreU(hn::Compress(v, microF), f, to + n); };
    put(ax, micro_.x[0]), put(ay, micro_.y[0]), putF(az, micro_.depth[0]);
    put(hn::IfThenElse(negative, cx, bx), micro_.x[1]), put(hn::IfThenElse(negative, cy, by), micro_.y[1]);
    put(hn::IfThenElse(negative, bx, cx), micro_.x[2]), put(hn::IfThenElse(negative, by, cy), micro_.y[2]);
    putF(hn::IfThenElse(negativeF, cz, bz), micro_.depth[1]);
    putF(hn::IfThenElse(negativeF, bz, cz), micro_.depth[2]);
    put(tag, micro_.triangle);
    micro_.count += hn::CountTrue(d, micro);
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
    if (batch_->isStream || batch_->draw->replaced.empty()) return hn::FirstN(d, kLanes);
    alignas(64) std::int32_t keep[kLanes];
    const std::size_t count = batch_->set->triangles.size();
    for (std::size_t i = 0; i < kLanes; ++i)
      keep[i] = first + i < count && batch_->isReplaced(static_cast<std::uint32_t>(first + i)) ? 0 : 1;
    return hn::Ne(hn::Load(d, keep), hn::Zero(d));
  }

  void sortLarge(std::size_t t, MI lanes, bool doubleSided) {
    alignas(64) std::int32_t large[kLanes];
    hn::Store(hn::VecFromMask(I(), lanes), I(), large);
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (large[i] == 0) continue;
      const auto triangle = static_cast<std::int32_t>(t + i);
      const Corners c = cornersOf(static_cast<std::uint32_t>(triangle));
      const std::int64_t area = signedArea(c);
      const bool back = batch_->mirrored ? area < 0 : area > 0;
      if (area == 0 || (back && !doubleSided)) continue;
      countFirst(c);
      rows_.triangle[rows_.count++] = triangle | (area < 0 ? kSwapped : 0) | (back ? kBack : 0);
    }
  }

  void countFirst(const Corners& c) const {
    const int bias = kSubpixels - 1 - tile_.sampleRange.high;
    const int x = (std::min({c.x[0], c.x[1], c.x[2]}) + bias) >> kSubpixelBits;
    const int y = (std::min({c.y[0], c.y[1], c.y[2]}) + bias) >> kSubpixelBits;
    tile_.statistics.trianglesDrawn += std::max(x, 0) >= tile_.left && std::max(y, 0) >= tile_.top ? 1 : 0;
  }

  // Numbers of a queued triangle's vertices in the cluster, in drawing order.
  HWY_INLINE void verticesOf(std::uint32_t tag, std::uint8_t (&v)[3]) const {
    const std::size_t t = cluster_->firstTriangle + (tag & (kClusterTriangles - 1U));
    const auto& corners = batch_->set->corners;
    const bool swapped = (tag & kSwapped) != 0;
    v[0] = corners[0][t];
    v[1] = corners[swapped ? 2 : 1][t];
    v[2] = corners[swapped ? 1 : 2][t];
  }

  Corners cornersOf(std::uint32_t tag) const {
    std::uint8_t v[3];
    verticesOf(tag, v);
    Corners c;
    for (int k = 0; k < 3; ++k) c.x[k] = block_->x[v[k]], c.y[k] = block_->y[v[k]];
    return c;
  }

  // TriangleSetup::setRecord.
  HWY_INLINE void writeRecord(std::uint32_t tag, const std::uint8_t (&v)[3], float x1, float x2, float y1,
                              float y2) {
    const F4 f;
    Record& r = tile_.records[tile_.recordCount];
    alignas(16) static constexpr float kSigns[2][4] = {{1.0F, 1.0F, 1.0F, 1.0F}, {-1.0F, -1.0F, -1.0F, 1.0F}};
    const auto sign = hn::Load(f, kSigns[(tag & kBack) != 0 ? 1 : 0]);
    const auto origin = hn::Mul(sign, hn::Load(f, block_->plane[v[0]]));
    const auto d1 = hn::Sub(hn::Mul(sign, hn::Load(f, block_->plane[v[1]])), origin);
    const auto d2 = hn::Sub(hn::Mul(sign, hn::Load(f, block_->plane[v[2]])), origin);
    hn::Store(origin, f, r.origin);
    hn::Store(hn::Sub(hn::Mul(d1, hn::Set(f, x1)), hn::Mul(d2, hn::Set(f, x2))), f, r.slopeX);
    hn::Store(hn::Sub(hn::Mul(d2, hn::Set(f, y2)), hn::Mul(d1, hn::Set(f, y1))), f, r.slopeY);
    r.x0 = block_->x[v[0]];
    r.y0 = block_->y[v[0]];
    r.source = source_ + (tag & (kClusterTriangles - 1U));
    r.attributes = kNoRecord;
  }

  // A vector of triangles from the micro queue.
  HWY_INLINE void drawMicro(std::size_t i) {
    const I d;
    const F f;
    const MI mine = hn::FirstN(d, micro_.count - i);
    VI x[3], y[3];
    for (int k = 0; k < 3; ++k) x[k] = hn::LoadU(d, micro_.x[k] + i), y[k] = hn::LoadU(d, micro_.y[k] + i);
    const PixelRange px =
        pixelsOf(tile_, min3(x[0], x[1], x[2]), max3(x[0], x[1], x[2]), tile_.left, tile_.width);
    const PixelRange py =
        pixelsOf(tile_, min3(y[0], y[1], y[2]), max3(y[0], y[1], y[2]), tile_.top, tile_.height);
    const VI wide = hn::IfThenElseZero(mine, hn::Sub(px.last, px.first));
    const VI high = hn::IfThenElseZero(mine, hn::Sub(py.last, py.first));
    const std::int32_t columns = hn::GetLane(hn::MaxOfLanes(d, wide)),
                       rows = hn::GetLane(hn::MaxOfLanes(d, high));

    const VI ux = hn::Sub(x[1], x[0]), uy = hn::Sub(y[1], y[0]), vx = hn::Sub(x[2], x[0]),
             vy = hn::Sub(y[2], y[0]);
    const VF inverse = hn::Div(hn::Set(f, 1.0F), hn::ConvertTo(f, hn::Sub(hn::Mul(ux, vy), hn::Mul(vx, uy))));
    const VF x1 = hn::Mul(hn::ConvertTo(f, vy), inverse), x2 = hn::Mul(hn::ConvertTo(f, uy), inverse);
    const VF y1 = hn::Mul(hn::ConvertTo(f, vx), inverse), y2 = hn::Mul(hn::ConvertTo(f, ux), inverse);
    const VF z0 = hn::LoadU(f, micro_.depth[0] + i);
    const VF d1 = hn::Sub(hn::LoadU(f, micro_.depth[1] + i), z0),
             d2 = hn::Sub(hn::LoadU(f, micro_.depth[2] + i), z0);
    const VF slopeX = hn::Sub(hn::Mul(d1, x1), hn::Mul(d2, x2)),
             slopeY = hn::Sub(hn::Mul(d2, y2), hn::Mul(d1, y1));
    MicroBatch batch;
    batch.first = i;
    hn::Store(x1, f, batch.x1), hn::Store(x2, f, batch.x2), hn::Store(y1, f, batch.y1),
        hn::Store(y2, f, batch.y2);
    hn::Store(hn::Set(d, -1), d, batch.id);

    VI edgeX[3], edgeY[3], bias[3];
    for (int k = 0; k < 3; ++k) {
      const int to = k == 2 ? 0 : k + 1;
      edgeX[k] = hn::Sub(x[to], x[k]), edgeY[k] = hn::Sub(y[to], y[k]);
      const MI topLeft = hn::Or(hn::Lt(edgeY[k], hn::Zero(d)),
                                hn::And(hn::Eq(edgeY[k], hn::Zero(d)), hn::Gt(edgeX[k], hn::Zero(d))));
      bias[k] = hn::IfThenElse(topLeft, hn::Zero(d), hn::Set(d, -1));
    }
    const VI corner = hn::Add(hn::Mul(hn::Sub(py.first, hn::Set(d, tile_.top)), hn::Set(d, tile_.stride)),
                              hn::Sub(px.first, hn::Set(d, tile_.left)));
    for (std::size_t s = 0; s < context_.samples.size(); ++s) {
      const SamplePosition at = context_.samples[s];
      const VI ox = hn::Add(hn::ShiftLeft<kSubpixelBits>(px.first), hn::Set(d, at.x));
      const VI oy = hn::Add(hn::ShiftLeft<kSubpixelBits>(py.first), hn::Set(d, at.y));
      VI e[3];
      for (int k = 0; k < 3; ++k)
        e[k] = hn::Add(hn::Sub(hn::Mul(edgeX[k], hn::Sub(oy, y[k])), hn::Mul(edgeY[k], hn::Sub(ox, x[k]))),
                       bias[k]);
      const VI base =
          hn::Add(corner, hn::Set(d, static_cast<std::int32_t>(tile_.offset(static_cast<int>(s), 0, 0))));
      for (std::int32_t j = 0; j <= rows; ++j) {
        const VI dy = hn::Add(hn::Sub(oy, y[0]), hn::Set(d, j * kSubpixels));
        const VF zRow = hn::Add(z0, hn::Mul(slopeY, hn::ConvertTo(f, dy)));
        const MI inRow = hn::And(mine, atMost(hn::Set(d, j), high));
        for (std::int32_t c = 0; c <= columns; ++c) {
          VI worst = hn::Zero(d);
          for (int k = 0; k < 3; ++k)
            worst = hn::Or(worst, hn::Sub(hn::Add(e[k], hn::Mul(edgeX[k], hn::Set(d, j * kSubpixels))),
                                          hn::Mul(edgeY[k], hn::Set(d, c * kSubpixels))));
          const MI covered =
              hn::And(hn::And(inRow, atMost(hn::Set(d, c), wide)), hn::Gt(worst, hn::Set(d, -1)));
          if (hn::AllFalse(d, covered)) continue;
          const VI dx = hn::Add(hn::Sub(ox, x[0]), hn::Set(d, c * kSubpixels));
          const VF z = hn::Add(zRow, hn::Mul(slopeX, hn::ConvertTo(f, dx)));
          writeMicro(batch, covered, z, hn::Add(base, hn::Set(d, j * tile_.stride + c)));
        }
      }
    }
  }

  struct MicroBatch {
    alignas(64) float x1[kLanes], x2[kLanes], y1[kLanes], y2[kLanes];
    alignas(64) std::int32_t id[kLanes];  // record of a triangle, or -1
    std::size_t first;
  };

  HWY_INLINE void writeMicro(MicroBatch& batch, MI covered, VF z, VI offset) {
    alignas(64) float depth[kLanes];
    alignas(64) std::int32_t at[kLanes];
    hn::Store(z, F(), depth);
    hn::Store(offset, I(), at);
    for (unsigned left = bitsOf(covered); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const auto o = static_cast<std::size_t>(at[lane]);
      if (depth[lane] < tile_.depth[o]) continue;
      const auto tag = static_cast<std::uint32_t>(micro_.triangle[batch.first + lane]);
      if (depth[lane] == tile_.depth[o] && !winsTie(tag, tile_.ids[o])) continue;
      if (batch.id[lane] < 0) {
        std::uint8_t v[3];
        verticesOf(tag, v);
        writeRecord(tag, v, batch.x1[lane], batch.x2[lane], batch.y1[lane], batch.y2[lane]);
        if (tile_.keepsCorners()) tile_.corners[tile_.recordCount] = microCorners(batch.first + lane);
        batch.id[lane] = static_cast<std::int32_t>(tile_.recordCount++);
      }
      tile_.depth[o] = depth[lane];
      tile_.ids[o] = static_cast<std::uint32_t>(batch.id[lane]);
    }
  }

  Corners microCorners(std::size_t i) const {
    Corners c;
    for (int k = 0; k < 3; ++k) c.x[k] = micro_.x[k][i], c.y[k] = micro_.y[k][i];
    return c;
  }

  bool winsTie(std::uint32_t tag, std::uint32_t other) const {
    if (other == kNoRecord) return true;
    const std::uint32_t triangle = cluster_->firstTriangle + (tag & (kClusterTriangles - 1U));
    return batch_->order(triangle) < tile_.orderOf(tile_.records[other]);
  }

  void drawRow(std::uint32_t tag) {
    std::uint8_t v[3];
    verticesOf(tag, v);
    Corners c;
    for (int k = 0; k < 3; ++k) c.x[k] = block_->x[v[k]], c.y[k] = block_->y[v[k]];
    const PlaneBasis basis(c);
    writeRecord(tag, v, basis.x1, basis.x2, basis.y1, basis.y2);
    if (tile_.keepsCorners()) tile_.corners[tile_.recordCount] = c;
    const int bias = kSubpixels - 1 - tile_.sampleRange.high, low = tile_.sampleRange.low;
    const int x0 = std::max(((std::min({c.x[0], c.x[1], c.x[2]}) + bias) >> kSubpixelBits) - tile_.left, 0);
    const int y0 = std::max(((std::min({c.y[0], c.y[1], c.y[2]}) + bias) >> kSubpixelBits) - tile_.top, 0);
    const int x1 =
        std::min(((std::max({c.x[0], c.x[1], c.x[2]}) - low) >> kSubpixelBits) - tile_.left + 1, tile_.width);
    const int y1 =
        std::min(((std::max({c.y[0], c.y[1], c.y[2]}) - low) >> kSubpixelBits) - tile_.top + 1, tile_.height);
    drawPixels(c, x0, y0, x1, y1);
  }

  // One edge over a box of pixels, divided by 256: value at the box's first sample and its steps.
  struct BoxEdge {
    std::int32_t value, stepX, stepY;
  };

  // False: no sample of the box is inside. An edge that all of them are inside of becomes 0, so that the others,
  // whose values change sign within the box, fit 32 bits.
  static bool setEdge(const Corners& c, int k, std::int32_t px, std::int32_t py, int columns, int rows,
                      BoxEdge& out) {
    const Edge edge = Edge::of(c, k, k == 2 ? 0 : k + 1);
    const std::int64_t value = edge.at(px, py) >> kSubpixelBits;
    const std::int64_t stepX = -static_cast<std::int64_t>(edge.dy), stepY = edge.dx;
    const std::int64_t acrossX = stepX * (columns - 1), acrossY = stepY * (rows - 1);
    // Whole vectors are drawn, so lanes beyond the box must be outside of some edge, too.
    constexpr auto kLast = static_cast<std::int64_t>(kLanes) - 1;
    const std::int64_t overX = stepX * (columns - 1 + kLast);
    const std::int64_t least = value + std::min<std::int64_t>(overX, 0) + std::min<std::int64_t>(acrossY, 0);
    const std::int64_t most = value + std::max<std::int64_t>(acrossX, 0) + std::max<std::int64_t>(acrossY, 0);
    out = least >= 0 ? BoxEdge{0, 0, 0} : BoxEdge{static_cast<std::int32_t>(value), -edge.dy, edge.dx};
    return most >= 0;
  }

  // Draws the record that is next to be kept over the pixels [x0, x1) × [y0, y1) of the tile.
  void drawPixels(const Corners& c, int x0, int y0, int x1, int y1) {
    bool won = false;
    for (std::size_t s = 0; s < context_.samples.size(); ++s) {
      const SamplePosition at = context_.samples[s];
      const std::int32_t px = (tile_.left + x0) * kSubpixels + at.x,
                         py = (tile_.top + y0) * kSubpixels + at.y;
      BoxEdge e[3];
      bool touched = true;
      for (int k = 0; k < 3; ++k) touched = setEdge(c, k, px, py, x1 - x0, y1 - y0, e[k]) && touched;
      if (touched) won |= drawColumns(e, px, py, tile_.offset(static_cast<int>(s), x0, y0), x1 - x0, y1 - y0);
    }
    if (won) ++tile_.recordCount;
  }

  HWY_INLINE bool drawColumns(const BoxEdge (&e)[3], std::int32_t px, std::int32_t py, std::size_t offset,
                              int columns, int rows) {
    const I d;
    const F f;
    const Record& record = tile_.records[tile_.recordCount];
    const VI id = hn::Set(d, static_cast<std::int32_t>(tile_.recordCount));
    const VI ramp = hn::Iota(d, 0);
    const VF origin = hn::Set(f, record.origin[3]), slopeY = hn::Set(f, record.slopeY[3]);
    const VF rowStep = hn::Set(f, static_cast<float>(kSubpixels));
    const VI step0 = hn::Set(d, e[0].stepY), step1 = hn::Set(d, e[1].stepY), step2 = hn::Set(d, e[2].stepY);
    MI won = hn::FirstN(d, 0);
    for (int column = 0; column < columns; column += static_cast<int>(kLanes)) {
      const auto start = [&](const BoxEdge& edge) {
        return hn::Add(hn::Set(d, edge.value + edge.stepX * column), hn::Mul(ramp, hn::Set(d, edge.stepX)));
      };
      VI e0 = start(e[0]), e1 = start(e[1]), e2 = start(e[2]);
      const VI dx =
          hn::Add(hn::Set(d, px - record.x0 + column * kSubpixels), hn::ShiftLeft<kSubpixelBits>(ramp));
      const VF zX = hn::Mul(hn::Set(f, record.slopeX[3]), hn::ConvertTo(f, dx));
      VF dy = hn::Set(f, static_cast<float>(py - record.y0));
      float* depthRow = tile_.depth.data() + offset + column;
      std::uint32_t* idRow = tile_.ids.data() + offset + column;
      for (int row = 0; row < rows; ++row) {
        const VF z = hn::Add(hn::Add(origin, hn::Mul(slopeY, dy)), zX);
        const VF old = hn::LoadU(f, depthRow);
        const MI covered = hn::Gt(hn::Or(hn::Or(e0, e1), e2), hn::Set(d, -1));
        MI wins = hn::And(covered, hn::RebindMask(d, hn::Ge(z, old)));
        if (!hn::AllFalse(d, wins)) {
          const MI ties = hn::And(wins, hn::RebindMask(d, hn::Eq(z, old)));
          if (!hn::AllFalse(d, ties)) wins = settleTies(record, idRow, wins, ties);
          hn::BlendedStore(z, hn::RebindMask(f, wins), f, depthRow);
          hn::BlendedStore(id, wins, d, reinterpret_cast<std::int32_t*>(idRow));
          won = hn::Or(won, wins);
        }
        e0 = hn::Add(e0, step0), e1 = hn::Add(e1, step1), e2 = hn::Add(e2, step2);
        dy = hn::Add(dy, rowStep);
        depthRow += tile_.stride;
        idRow += tile_.stride;
      }
    }
    return !hn::AllFalse(d, won);
  }

  // Takes the ties that the record loses out of the lanes that it wins.
  MI settleTies(const Record& record, const std::uint32_t* ids, MI wins, MI ties) const {
    const I d;
    alignas(64) std::int32_t lanes[kLanes];
    hn::Store(hn::VecFromMask(d, ties), d, lanes);
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (lanes[i] == 0) continue;
      const bool first = ids[i] == kNoRecord || tile_.orderOf(record) < tile_.orderOf(tile_.records[ids[i]]);
      lanes[i] = first ? 0 : -1;
    }
    return hn::AndNot(hn::Ne(hn::Load(d, lanes), hn::Zero(d)), wins);
  }

  Tile& tile_;
  const FrameContext& context_;
  const Batch* batch_ = nullptr;
  const Cluster* cluster_ = nullptr;
  const VertexBlock* block_ = nullptr;
  std::uint32_t source_ = 0;
  MicroQueue micro_;
  RowQueue rows_;
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
