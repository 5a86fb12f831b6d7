// Triangles drawn one by one with several samples per pixel. Definition: drawTriangle in visibility.cpp.
//
// A vector holds four samples each of as many neighbouring pixels as fit, which is a line of the cache with 16 lanes: small
// triangles fill such a vector better than one of 16 pixels, and nothing is loaded or stored across lines. The pixels'
// normals and depths at their centres are four numbers each and fill the same vector.
#if defined(LIMN_RASTER_MULTISAMPLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_MULTISAMPLE_INL_H_
#undef LIMN_RASTER_MULTISAMPLE_INL_H_
#else
#define LIMN_RASTER_MULTISAMPLE_INL_H_
#endif

#include "raster/boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// Pixels of a vector of samples.
inline constexpr int kPixels = static_cast<int>(kLanes / kGroup);

class Multisample {
 public:
  explicit Multisample(Tile& tile) : tile_(tile), samples_(tile.context->samples) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const auto pixel = static_cast<std::int32_t>(i / kGroup) * kSubpixels;
      for (std::size_t g = 0; g < samples_.size() / kGroup; ++g) {
        sampleX_[g][i] = pixel + samples_[g * kGroup + i % kGroup].x;
        sampleY_[g][i] = pixel + samples_[g * kGroup + i % kGroup].y;
      }
      pixel_[i] = pixel;
    }
  }

  /// Draws a queue of triangles without slivers whose edge functions fit 32 bits.
  void draw(const ClusterInTile& cluster, const TriangleQueue& queue) {
    for (std::size_t i = 0; i < queue.count; i += kLanes) {
      boxes_.set(tile_, queue, i);
      boxes_.setSpans<kPixels>();
      for (std::size_t lane = 0; lane < kLanes && i + lane < queue.count; ++lane) {
        cluster.prepareRecord(tile_, static_cast<std::uint32_t>(queue.tag[i + lane]), boxes_.basis[0][lane],
                              boxes_.basis[1][lane], boxes_.basis[2][lane], boxes_.basis[3][lane]);
        setCenterEdges(lane);
        drawBox(lane);
      }
    }
  }

  /// Draws the record that is next to be kept, over the pixels [x0, x1) × [y0, y1) of the tile.
  void draw(const Corners& c, int x0, int y0, int x1, int y1) {
    if (!boxes_.set(tile_, c, x0, y0, x1, y1)) return;
    tile_.centerEdges[tile_.recordCount] = tile_.centerEdgesOf(c);
    boxes_.setSpans<kPixels>();
    drawBox(0);
  }

 private:
  static constexpr std::size_t kMaxRows = 64, kMaxGroups = kMaxSamples / kGroup;

  HWY_INLINE void drawBox(std::size_t lane) {
    if (samples_.size() == kGroup ? drawBox<1>(lane) : drawBox<2>(lane)) ++tile_.recordCount;
  }

  HWY_INLINE void setCenterEdges(std::size_t lane) {
    CenterEdges& edges = tile_.centerEdges[tile_.recordCount];
    for (int k = 0; k < 3; ++k) {
      const std::int32_t stepX = boxes_.stepX[k][lane], stepY = boxes_.stepY[k][lane];
      edges.value[k] = boxes_.center[k][lane] - boxes_.x0[lane] * stepX - boxes_.y0[lane] * stepY;
      edges.stepX[k] = stepX, edges.stepY[k] = stepY;
    }
    edges.value[3] = edges.stepX[3] = edges.stepY[3] = 0;
  }

  // The rows' starts, origin + slopeY · dy: of depth at the samples, of all planes at the pixels' centres.
  template <std::size_t kGroups>
  HWY_INLINE void startRows(const Record& record, std::int32_t py, int rows) {
    const I d;
    const F f;
    const VF depth = hn::Set(f, record.origin[3]), depthSlope = hn::Set(f, record.slopeY[3]);
    const VF origin = hn::LoadDup128(f, record.origin), slope = hn::LoadDup128(f, record.slopeY);
    const VI pixel = hn::Load(d, pixel_);
    for (int row = 0; row < rows; row += kPixels) {
      const VI y = hn::Set(d, py + row * kSubpixels);
      forEach(std::make_index_sequence<kGroups>(), [&](auto g) HWY_ATTR {
        const VF dy = hn::ConvertTo(f, hn::Add(y, hn::Load(d, sampleY_[g])));
        hn::Store(hn::Add(depth, hn::Mul(depthSlope, dy)), f,
                  depthStarts_[g] + row * static_cast<int>(kGroup));
      });
      const VF dy = hn::ConvertTo(f, hn::Add(hn::Add(y, hn::Set(d, kOneSample[0].y)), pixel));
      hn::Store(hn::Add(origin, hn::Mul(slope, dy)), f, starts_ + row * static_cast<int>(kGroup));
    }
  }

  template <std::size_t kGroups>
  HWY_INLINE bool drawBox(std::size_t lane) {
    const I d;
    const F f;
    constexpr std::make_index_sequence<kGroups> groups;
    const Record& record = tile_.records[tile_.recordCount];
    const VI number = hn::Set(d, static_cast<std::int32_t>(tile_.recordCount));
    const int y0 = boxes_.y0[lane], before = boxes_.x0[lane] % kPixels, x0 = boxes_.x0[lane] - before;
    const int columns = (before + boxes_.columns[lane] + kPixels - 1) / kPixels;
    const std::int32_t px = (tile_.left + x0) * kSubpixels - record.x0,
                       py = (tile_.top + y0) * kSubpixels - record.y0;
    boxes_.setRows(lane, columns);
    startRows<kGroups>(record, py, boxes_.rows[lane]);
    const VI pixel = hn::Load(d, pixel_), pixelCenter = hn::Add(pixel, hn::Set(d, kOneSample[0].x));
    VI start[kGroups][3], step[3];
    for (int k = 0; k < 3; ++k) {
      const std::int32_t stepX = boxes_.stepX[k][lane];
      step[k] = hn::Set(d, boxes_.stepY[k][lane]);
      const VI across = hn::Sub(hn::Mul(hn::ShiftRight<kSubpixelBits>(pixel), hn::Set(d, stepX)),
                                hn::Set(d, before * stepX));
      for (std::size_t g = 0; g < kGroups; ++g)
        start[g][k] = hn::Add(hn::LoadDup128(d, boxes_.valuesOf(lane, k, g)), across);
    }
    const VF depthSlope = hn::Set(f, record.slopeX[3]), slope = hn::LoadDup128(f, record.slopeX);
    constexpr std::size_t kStride = Tile::kStripWidth * kGroup;
    const std::size_t plane = tile_.plane * kGroup;
    float *const depths = tile_.depth.data(), *const centers = tile_.centers.data();
    std::uint32_t* const ids = tile_.ids.data();
    MI won = hn::FirstN(d, 0);
    for (int column = 0; column < columns; ++column) {
      const int first = boxes_.firstRow[column], last = boxes_.lastRow[column];
      if (first > last) continue;
      const VI x = hn::Set(d, px + column * (kPixels * kSubpixels));
      VI e[kGroups][3];
      VF zX[kGroups];
      forEach(groups, [&](auto g) HWY_ATTR {
        for (int k = 0; k < 3; ++k)
          e[g][k] = hn::Add(start[g][k], hn::Set(d, boxes_.stepX[k][lane] * (column * kPixels) +
                                                        boxes_.stepY[k][lane] * first));
        zX[g] = hn::Mul(depthSlope, hn::ConvertTo(f, hn::Add(x, hn::Load(d, sampleX_[g]))));
      });
      const VF across = hn::Mul(slope, hn::ConvertTo(f, hn::Add(x, pixelCenter)));
      std::size_t o = tile_.offset(0, x0 + column * kPixels, y0 + first);
      for (int row = first; row <= last; ++row, o += kStride) {
        MI wonHere[kGroups];
        forEach(groups, [&](auto g) HWY_ATTR {
          float* const depth = depths + o + g * plane;
          std::uint32_t* const id = ids + o + g * plane;
          const VF z = hn::Add(hn::LoadDup128(f, depthStarts_[g] + row * static_cast<int>(kGroup)), zX[g]);
          const VF old = hn::Load(f, depth);
          const MI covered = hn::Gt(hn::Or(hn::Or(e[g][0], e[g][1]), e[g][2]), hn::Set(d, -1));
          MI wins = hn::And(covered, hn::RebindMask(d, hn::Ge(z, old)));
          const MI ties = hn::And(covered, hn::RebindMask(d, hn::Eq(z, old)));
          if (HWY_UNLIKELY(!hn::AllFalse(d, ties))) wins = settleTies(tile_, record, id, wins, ties);
          storeWhere(z, hn::RebindMask(f, wins), f, depth);
          storeWhere(number, wins, d, reinterpret_cast<std::int32_t*>(id));
          won = hn::Or(won, wins);
          wonHere[g] = wins;
          for (int k = 0; k < 3; ++k) e[g][k] = hn::Add(e[g][k], step[k]);
        });
        const VF values = hn::Add(hn::LoadDup128(f, starts_ + row * static_cast<int>(kGroup)), across);
        // Whole where all samples of a pixel were won: no others are going to be read.
        storeWhere(values, hn::RebindMask(f, wonHere[0]), f, centers + o);
      }
    }
    return !hn::AllFalse(d, won);
  }

  Tile& tile_;
  std::span<const SamplePosition> samples_;
  // By lanes: sub-pixels from a vector's first pixel to the lane's sample, and to its pixel.
  alignas(64) std::int32_t sampleX_[kMaxGroups][kLanes], sampleY_[kMaxGroups][kLanes], pixel_[kLanes];
  Boxes boxes_;
  // Of one triangle.
  alignas(64) float depthStarts_[kMaxGroups][(kMaxRows + kPixels) * kGroup],
      starts_[(kMaxRows + kPixels) * kGroup];
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
