// Visibility of a tile: the nearest triangle of every sample.
//
// Based on: J. Pineda, "A parallel algorithm for polygon rasterization", 1988; C. Burns, W. Hunt, "The
// Visibility Buffer", 2013. Differs in: equal depths go to the triangle submitted first, so that the result
// depends on no order of drawing.
#include <algorithm>

#include "raster/tile.h"

namespace limn::raster {
namespace {

// A triangle as it comes: corners in submitted order, with pointers to their planes (see VertexBlock).
struct Input {
  Corners corners;
  const float* plane[3];
  std::uint32_t source;
};

class Rasterizer {
 public:
  explicit Rasterizer(Tile& tile) : tile_(tile), context_(*tile.context) {}

  void draw(Input& in, bool mirrored, bool doubleSided) {
    std::int64_t area = signedArea(in.corners);
    // With y pointing down a triangle that is counter-clockwise in view space has a negative area.
    const bool back = mirrored ? area < 0 : area > 0;
    if (area == 0 || (back && !doubleSided)) return;
    if (area < 0) {
      std::swap(in.corners.x[1], in.corners.x[2]);
      std::swap(in.corners.y[1], in.corners.y[2]);
      std::swap(in.plane[1], in.plane[2]);
    }
    if (!setBounds(in.corners)) return;
    setRecord(in, back);
    for (int i = 0; i < 3; ++i) edges_[i] = Edge::of(in.corners, i, (i + 1) % 3);
    if (isFirstTile(in.corners)) ++tile_.statistics.trianglesDrawn;
    kept_ = kNoRecord;
    for (int s = 0; s < static_cast<int>(context_.samples.size()); ++s) drawSample(s);
  }

 private:
  // Pixels of the tile that the triangle's box touches.
  bool setBounds(const Corners& c) {
    const auto [minX, maxX] = std::minmax({c.x[0], c.x[1], c.x[2]});
    const auto [minY, maxY] = std::minmax({c.y[0], c.y[1], c.y[2]});
    x0_ = std::max((minX >> kSubpixelBits) - tile_.left, 0);
    x1_ = std::min((maxX >> kSubpixelBits) - tile_.left + 1, tile_.width);
    y0_ = std::max((minY >> kSubpixelBits) - tile_.top, 0);
    y1_ = std::min((maxY >> kSubpixelBits) - tile_.top + 1, tile_.height);
    return x0_ < x1_ && y0_ < y1_;
  }

  // A triangle counts in the tile where its box begins.
  bool isFirstTile(const Corners& c) const {
    const int minX = std::min({c.x[0], c.x[1], c.x[2]}) >> kSubpixelBits;
    const int minY = std::min({c.y[0], c.y[1], c.y[2]}) >> kSubpixelBits;
    return std::max(minX, 0) >= tile_.left && std::max(minY, 0) >= tile_.top;
  }

  void setRecord(const Input& in, bool back) {
    const PlaneBasis basis(in.corners);
    for (int i = 0; i < 4; ++i) {
      const float sign = back && i < 3 ? -1.0F : 1.0F;  // a back face shows its other side
      const Slopes s = basis.slopes(sign * in.plane[0][i], sign * in.plane[1][i], sign * in.plane[2][i]);
      record_.origin[i] = sign * in.plane[0][i];
      record_.slopeX[i] = s.x;
      record_.slopeY[i] = s.y;
    }
    record_.x0 = in.corners.x[0];
    record_.y0 = in.corners.y[0];
    record_.source = in.source;
    record_.attributes = kNoRecord;
  }

  void drawSample(int s) {
    const SamplePosition at = context_.samples[static_cast<std::size_t>(s)];
    for (int y = y0_; y < y1_; ++y)
      for (int x = x0_; x < x1_; ++x) {
        const std::int32_t px = (tile_.left + x) * kSubpixels + at.x,
                           py = (tile_.top + y) * kSubpixels + at.y;
        if (edges_[0].at(px, py) < 0 || edges_[1].at(px, py) < 0 || edges_[2].at(px, py) < 0) continue;
        const float depth = record_.value(3, px, py);
        const std::size_t o = tile_.offset(s, x, y);
        if (depth > tile_.depth[o] || (depth == tile_.depth[o] && winsTie(tile_.ids[o]))) {
          tile_.depth[o] = depth;
          tile_.ids[o] = keep();
        }
      }
  }

  bool winsTie(std::uint32_t other) const {
    return other == kNoRecord || tile_.orderOf(record_) < tile_.orderOf(tile_.records[other]);
  }

  // Only triangles that win a sample get a record.
  std::uint32_t keep() {
    if (kept_ == kNoRecord) {
      kept_ = static_cast<std::uint32_t>(tile_.records.size());
      tile_.records.push_back(record_);
    }
    return kept_;
  }

  Tile& tile_;
  const FrameContext& context_;
  Edge edges_[3];
  Record record_;
  std::uint32_t kept_ = kNoRecord;
  int x0_ = 0, y0_ = 0, x1_ = 0, y1_ = 0;
};

void drawCluster(Tile& tile, std::uint32_t entry, Rasterizer& rasterizer) {
  const FrameContext& context = *tile.context;
  const VisibleCluster& visible = context.front.cluster(tile.clusters[entry]);
  const Batch& batch = context.batches[visible.batch];
  const ClusterSet& set = *batch.set;
  const Cluster& cluster = set.clusters[visible.cluster];
  const bool doubleSided = context.frame.materials[cluster.material].doubleSided;
  VertexBlock& block = tile.blocks[entry];
  transformCluster(batch, cluster, context.map, block);
  for (std::uint32_t t = 0; t < cluster.triangleCount; ++t) {
    if (batch.isReplaced(cluster.firstTriangle + t)) continue;
    Input in;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint8_t i = set.corners[k][cluster.firstTriangle + t];
      in.corners.x[k] = block.x[i], in.corners.y[k] = block.y[i];
      in.plane[k] = block.plane[i];
    }
    in.source = entry * kClusterTriangles + t;
    rasterizer.draw(in, batch.mirrored, doubleSided);
  }
}

void drawLoose(std::uint32_t item, const FrameContext& context, Rasterizer& rasterizer) {
  const LooseTriangle& t = context.front.loose(item);
  const Batch& batch = context.batches[t.ref.batch];
  Input in;
  for (int k = 0; k < 3; ++k) {
    in.corners.x[k] = t.x[k], in.corners.y[k] = t.y[k];
    in.plane[k] = t.plane[k];
  }
  in.source = Record::kLoose | item;
  rasterizer.draw(in, batch.mirrored,
                  context.frame.materials[batch.set->clusters[t.ref.cluster].material].doubleSided);
}

}  // namespace

void resolveVisibility(Tile& tile) {
  Rasterizer rasterizer(tile);
  for (std::uint32_t entry = 0; entry < tile.clusters.size(); ++entry) drawCluster(tile, entry, rasterizer);
  for (const std::uint32_t item : tile.loose) drawLoose(item, *tile.context, rasterizer);
}

}  // namespace limn::raster
