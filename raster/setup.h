// A triangle made ready for a tile: the order of its corners, its edges, its planes, the pixels it may touch.
#pragma once

#include <algorithm>

#include "raster/tile.h"

namespace limn::raster {

/// Pixels of a tile, from its corner, the last ones excluded.
struct PixelBox {
  int x0, y0, x1, y1;
  bool isEmpty() const { return x0 >= x1 || y0 >= y1; }
};

/// First pixel (of the window) of a range of sub-pixels that holds a sample in it.
inline int firstPixel(const Tile& tile, std::int32_t low) {
  return (low - tile.sampleRange.high + kSubpixels - 1) >> kSubpixelBits;
}
inline int lastPixel(const Tile& tile, std::int32_t high) {
  return (high - tile.sampleRange.low) >> kSubpixelBits;
}

/// The pixels of the tile that a triangle may cover samples of.
inline PixelBox pixelsOf(const Tile& tile, const Corners& c) {
  const Box box = boxOf(c);
  return {std::max(firstPixel(tile, box.minX) - tile.left, 0),
          std::max(firstPixel(tile, box.minY) - tile.top, 0),
          std::min(lastPixel(tile, box.maxX) - tile.left + 1, tile.width),
          std::min(lastPixel(tile, box.maxY) - tile.top + 1, tile.height)};
}

/// Whether the triangle counts in this tile: where those pixels begin.
inline bool isFirstTile(const Tile& tile, const Corners& c) {
  const Box box = boxOf(c);
  return std::max(firstPixel(tile, box.minX), 0) >= tile.left &&
         std::max(firstPixel(tile, box.minY), 0) >= tile.top;
}

class TriangleSetup {
 public:
  /// False: nothing of the triangle can be drawn in the tile. `planes` are of the corners in submitted order, or
  /// of the points `anchors`.
  bool set(const Tile& tile, Corners c, const float* const planes[3], std::uint32_t source, bool mirrored,
           bool doubleSided, const Corners* anchors = nullptr) {
    const std::int64_t area = signedArea(c);
    const bool back = facesAway(area, mirrored);
    if (area == 0 || (back && !doubleSided)) return false;
    const float* ordered[3] = {planes[0], planes[1], planes[2]};
    if (area < 0) {
      std::swap(c.x[1], c.x[2]);
      std::swap(c.y[1], c.y[2]);
      if (anchors == nullptr) std::swap(ordered[1], ordered[2]);
    }
    corners = c;
    pixels = pixelsOf(tile, corners);
    if (pixels.isEmpty()) return false;
    for (int i = 0; i < 3; ++i) edges_[i] = Edge::of(c, i, (i + 1) % 3);
    setRecord(anchors != nullptr ? *anchors : corners, ordered, source, back);
    return true;
  }

  bool coversPoint(std::int32_t x, std::int32_t y) const {
    return edges_[0].at(x, y) >= 0 && edges_[1].at(x, y) >= 0 && edges_[2].at(x, y) >= 0;
  }

  /// Samples of a pixel (from the tile's corner) that the triangle covers.
  unsigned coverage(const Tile& tile, int x, int y) const {
    const std::int32_t px = (tile.left + x) * kSubpixels, py = (tile.top + y) * kSubpixels;
    unsigned mask = 0;
    for (std::size_t s = 0; s < tile.context->samples.size(); ++s) {
      const SamplePosition at = tile.context->samples[s];
      mask |= static_cast<unsigned>(coversPoint(px + at.x, py + at.y)) << s;
    }
    return mask;
  }

  float depthAt(const Tile& tile, std::size_t sample, int x, int y) const {
    const SamplePosition at = tile.context->samples[sample];
    return record.value(3, (tile.left + x) * kSubpixels + at.x, (tile.top + y) * kSubpixels + at.y);
  }

  Corners corners;
  Record record;
  PixelBox pixels;

 private:
  void setRecord(const Corners& anchors, const float* const plane[3], std::uint32_t source, bool back) {
    const PlaneBasis basis(anchors);
    for (int i = 0; i < 4; ++i) {
      const float sign = back && i < 3 ? -1.0F : 1.0F;  // a back face shows its other side
      const Slopes s = basis.slopes(sign * plane[0][i], sign * plane[1][i], sign * plane[2][i]);
      record.origin[i] = sign * plane[0][i];
      record.slopeX[i] = s.x;
      record.slopeY[i] = s.y;
    }
    record.x0 = anchors.x[0];
    record.y0 = anchors.y[0];
    record.source = source;
    record.attributes = kNoRecord;
  }

  Edge edges_[3];
};

/// The same for a triangle drawn on its own.
inline bool setLoose(const Tile& tile, std::uint32_t item, TriangleSetup& setup) {
  const FrameContext& context = *tile.context;
  const LooseTriangle& t = context.front.loose(item);
  const Batch& batch = context.batches[t.ref.batch];
  const float* const planes[3] = {t.plane[0], t.plane[1], t.plane[2]};
  const Material& m = context.frame.materials[batch.set->clusters[t.ref.cluster].material];
  return setup.set(tile, t.corners, planes, Record::kLoose | item, batch.mirrored, m.doubleSided,
                   t.cut ? &t.anchors : nullptr);
}

}  // namespace limn::raster
