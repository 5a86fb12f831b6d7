// A cluster in a tile, as the vector kernels of visibility see it.
#if defined(LIMN_RASTER_CLUSTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_CLUSTER_INL_H_
#undef LIMN_RASTER_CLUSTER_INL_H_
#else
#define LIMN_RASTER_CLUSTER_INL_H_
#endif

#include "raster/tile.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
// A triangle of the cluster in the queues: its number and how its corners were turned.
constexpr std::int32_t kSwapped = 128, kBack = 256;

struct ClusterInTile {
  const Batch* batch = nullptr;
  const Cluster* cluster = nullptr;
  const VertexBlock* block = nullptr;
  std::uint32_t source = 0;  ///< of its first triangle, as records have it

  /// Numbers of a queued triangle's vertices in the cluster, in drawing order.
  HWY_INLINE void verticesOf(std::uint32_t tag, std::uint8_t (&v)[3]) const {
    const std::size_t t = cluster->firstTriangle + (tag & (kClusterTriangles - 1U));
    const auto& corners = batch->set->corners;
    const bool swapped = (tag & kSwapped) != 0;
    v[0] = corners[0][t];
    v[1] = corners[swapped ? 2 : 1][t];
    v[2] = corners[swapped ? 1 : 2][t];
  }

  Corners cornersOf(std::uint32_t tag) const {
    std::uint8_t v[3];
    verticesOf(tag, v);
    Corners c;
    for (int k = 0; k < 3; ++k) c.x[k] = block->x[v[k]], c.y[k] = block->y[v[k]];
    return c;
  }

  /// TriangleSetup::setRecord, given the triangle's PlaneBasis.
  HWY_INLINE void setRecord(std::uint32_t tag, float x1, float x2, float y1, float y2, Record& r) const {
    const F4 f;
    std::uint8_t v[3];
    verticesOf(tag, v);
    alignas(16) static constexpr float kSigns[2][4] = {{1.0F, 1.0F, 1.0F, 1.0F}, {-1.0F, -1.0F, -1.0F, 1.0F}};
    const auto sign = hn::Load(f, kSigns[(tag & kBack) != 0 ? 1 : 0]);
    const auto origin = hn::Mul(sign, hn::Load(f, block->plane[v[0]]));
    const auto d1 = hn::Sub(hn::Mul(sign, hn::Load(f, block->plane[v[1]])), origin);
    const auto d2 = hn::Sub(hn::Mul(sign, hn::Load(f, block->plane[v[2]])), origin);
    hn::Store(origin, f, r.origin);
    hn::Store(hn::Sub(hn::Mul(d1, hn::Set(f, x1)), hn::Mul(d2, hn::Set(f, x2))), f, r.slopeX);
    hn::Store(hn::Sub(hn::Mul(d2, hn::Set(f, y2)), hn::Mul(d1, hn::Set(f, y1))), f, r.slopeY);
    r.x0 = block->x[v[0]];
    r.y0 = block->y[v[0]];
    r.source = source + (tag & (kClusterTriangles - 1U));
    r.attributes = kNoRecord;
  }

  /// attributesOf() as far as texture coordinates go, given the triangle's record.
  HWY_INLINE void setTexturePlanes(std::uint32_t tag, float x1, float x2, float y1, float y2, const Record& r,
                                   bool perspective, TexturePlanes& p) const {
    std::uint8_t v[3];
    verticesOf(tag, v);
    for (int i = 0; i < 2; ++i) {
      const float origin = block->texcoord[v[0]][i];
      const float d1 = block->texcoord[v[1]][i] - origin, d2 = block->texcoord[v[2]][i] - origin;
      p.origin[i] = origin;
      p.slopeX[i] = d1 * x1 - d2 * x2;
      p.slopeY[i] = d2 * y2 - d1 * y1;
    }
    p.slopeQ[0] = perspective ? r.slopeX[3] : 0.0F;
    p.slopeQ[1] = perspective ? r.slopeY[3] : 0.0F;
    p.x0 = r.x0, p.y0 = r.y0;
  }

  /// The record that is next to be kept, and what belongs to it.
  HWY_INLINE void prepareRecord(Tile& tile, std::uint32_t tag, float x1, float x2, float y1, float y2) const {
    Record& record = tile.records[tile.recordCount];
    setRecord(tag, x1, x2, y1, y2, record);
    if (tile.texturedMaterial != nullptr)
      setTexturePlanes(tag, x1, x2, y1, y2, record, tile.context->map.perspective,
                       tile.texturePlanes[tile.recordCount]);
  }
};

/// First and last pixel (in the window) of a range of sub-pixels that hold a sample in it, clipped to the tile.
struct PixelRange {
  VI first, last;
  VI begin;  ///< first, not clipped
};

HWY_INLINE PixelRange pixelsOf(const Tile& tile, VI low, VI high, int from, int size) {
  const I d;
  const VI begin =
      hn::ShiftRight<kSubpixelBits>(hn::Add(low, hn::Set(d, kSubpixels - 1 - tile.sampleRange.high)));
  const VI last = hn::ShiftRight<kSubpixelBits>(hn::Sub(high, hn::Set(d, tile.sampleRange.low)));
  return {hn::Max(begin, hn::Set(d, from)), hn::Min(last, hn::Set(d, from + size - 1)), begin};
}

HWY_INLINE VI min3(VI a, VI b, VI c) {
  return hn::Min(hn::Min(a, b), c);
}
HWY_INLINE VI max3(VI a, VI b, VI c) {
  return hn::Max(hn::Max(a, b), c);
}

/// Triangles waiting to be drawn, corners in the order that makes the area positive.
struct TriangleQueue {
  static constexpr std::size_t kSize = kClusterTriangles + 16;
  alignas(64) std::int32_t x[3][kSize], y[3][kSize];
  alignas(64) std::int32_t tag[kSize];
  std::size_t count = 0;
};

/// Edges, boxes and interpolation of a vector of queued triangles whose edge functions fit 32 bits.
struct TriangleVector {
  VI x[3], y[3];
  VI edgeX[3], edgeY[3], bias[3];
  PixelRange px, py;
  VF x1, x2, y1, y2;  // PlaneBasis, none of them slivers

  HWY_INLINE TriangleVector(const Tile& tile, const TriangleQueue& queue, std::size_t first) {
    const I d;
    const F f;
    for (int k = 0; k < 3; ++k)
      x[k] = hn::LoadU(d, queue.x[k] + first), y[k] = hn::LoadU(d, queue.y[k] + first);
    px = pixelsOf(tile, min3(x[0], x[1], x[2]), max3(x[0], x[1], x[2]), tile.left, tile.width);
    py = pixelsOf(tile, min3(y[0], y[1], y[2]), max3(y[0], y[1], y[2]), tile.top, tile.height);
    for (int k = 0; k < 3; ++k) {
      const int to = k == 2 ? 0 : k + 1;
      edgeX[k] = hn::Sub(x[to], x[k]), edgeY[k] = hn::Sub(y[to], y[k]);
      const MI topLeft = hn::Or(hn::Lt(edgeY[k], hn::Zero(d)),
                                hn::And(hn::Eq(edgeY[k], hn::Zero(d)), hn::Gt(edgeX[k], hn::Zero(d))));
      bias[k] = hn::IfThenElse(topLeft, hn::Zero(d), hn::Set(d, -1));
    }
    const VI vx = hn::Sub(x[2], x[0]), vy = hn::Sub(y[2], y[0]);
    const VI area = hn::Sub(hn::Mul(edgeX[0], vy), hn::Mul(edgeY[0], vx));
    const VF inverse = hn::Div(hn::Set(f, 1.0F), hn::ConvertTo(f, area));
    x1 = hn::Mul(hn::ConvertTo(f, vy), inverse), x2 = hn::Mul(hn::ConvertTo(f, edgeY[0]), inverse);
    y1 = hn::Mul(hn::ConvertTo(f, vx), inverse), y2 = hn::Mul(hn::ConvertTo(f, edgeX[0]), inverse);
  }

  /// Edge functions at a sample of the boxes' first pixels.
  HWY_INLINE VI edgeAt(int k, SamplePosition at) const {
    const I d;
    const VI ox = hn::Add(hn::ShiftLeft<kSubpixelBits>(px.first), hn::Set(d, at.x));
    const VI oy = hn::Add(hn::ShiftLeft<kSubpixelBits>(py.first), hn::Set(d, at.y));
    return hn::Add(hn::Sub(hn::Mul(edgeX[k], hn::Sub(oy, y[k])), hn::Mul(edgeY[k], hn::Sub(ox, x[k]))),
                   bias[k]);
  }
};

/// Takes the ties that a record loses to those seen so far out of the lanes that it wins.
HWY_NOINLINE MI settleTies(const Tile& tile, const Record& record, const std::uint32_t* ids, MI wins,
                           MI ties) {
  const I d;
  const VI shown = hn::LoadU(d, reinterpret_cast<const std::int32_t*>(ids));
  const std::uint64_t order = tile.orderOf(record);
  while (!hn::AllFalse(d, ties)) {  // for each triangle that is tied with
    const std::uint32_t id = ids[static_cast<std::size_t>(hn::FindFirstTrue(d, ties))];
    const MI same = hn::And(ties, hn::Eq(shown, hn::Set(d, static_cast<std::int32_t>(id))));
    ties = hn::AndNot(same, ties);
    const bool first = id == kNoRecord || order < tile.orderOf(tile.records[id]);
    if (!first) wins = hn::AndNot(same, wins);
  }
  return wins;
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
