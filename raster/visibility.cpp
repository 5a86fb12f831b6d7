// Visibility of a tile: the nearest triangle of every sample. The definition of the vector kernels.
//
// Based on: J. Pineda, "A parallel algorithm for polygon rasterization", 1988; C. Burns, W. Hunt, "The Visibility
// Buffer", 2013.
// Differs in: equal depths go to the triangle submitted first, so that the result depends on no order of drawing.
#include "raster/kernels.h"
#include "raster/setup.h"
#include "raster/surface.h"
#include "raster/tile.h"

namespace limn::raster {
namespace {

bool winsTie(const Tile& tile, const Record& record, std::uint32_t other) {
  return other == kNoRecord || tile.orderOf(record) < tile.orderOf(tile.records[other]);
}

// What an alpha mask leaves of a pixel: all or nothing.
bool passesMask(Tile& tile, TriangleSetup& t, const Surface& surface, unsigned coverage, int x, int y) {
  const SamplePosition at = shadingPoint(tile, t.corners, coverage, x, y);
  return baseColorAt(tile, t.record, surface, at).w >= surface.material->alphaCutoff;
}

void drawTriangle(Tile& tile, TriangleSetup& t) {
  const Surface surface = tile.surfaceOf(t.record);
  const bool masked = surface.material->alphaMode == AlphaMode::kMask;
  if (isFirstTile(tile, t.corners)) ++tile.statistics.trianglesDrawn;
  tile.touch(t.pixels.x0, t.pixels.y0, t.pixels.x1, t.pixels.y1);
  std::uint32_t id = kNoRecord;  // only triangles that win a sample get a record
  for (int y = t.pixels.y0; y < t.pixels.y1; ++y)
    for (int x = t.pixels.x0; x < t.pixels.x1; ++x) {
      const unsigned coverage = t.coverage(tile, x, y);
      unsigned won = 0;
      for (unsigned s = 0; s < tile.context->samples.size(); ++s) {
        if (((coverage >> s) & 1U) == 0) continue;
        const std::size_t o = tile.offset(static_cast<int>(s), x, y);
        const float depth = t.depthAt(tile, s, x, y);
        const bool wins =
            depth > tile.depth[o] || (depth == tile.depth[o] && winsTie(tile, t.record, tile.ids[o]));
        won |= static_cast<unsigned>(wins) << s;
      }
      if (won == 0 || (masked && !passesMask(tile, t, surface, coverage, x, y))) continue;
      if (id == kNoRecord) id = tile.add(t.record, t.corners);
      for (unsigned s = 0; won >> s != 0; ++s) {
        if (((won >> s) & 1U) == 0) continue;
        const std::size_t o = tile.offset(static_cast<int>(s), x, y);
        tile.depth[o] = t.depthAt(tile, s, x, y);
        tile.ids[o] = id;
      }
      tile.setPoint(t.record, x, y);
    }
}

}  // namespace

void drawClusterScalar(Tile& tile, std::uint32_t entry) {
  const FrameContext& context = *tile.context;
  const VisibleCluster& visible = context.front.cluster(tile.clusters[entry]);
  const Batch& batch = context.batches[visible.batch];
  const ClusterSet& set = *batch.set;
  const Cluster& cluster = set.clusters[visible.cluster];
  const bool doubleSided = context.frame.materials[cluster.material].doubleSided;
  const VertexBlock& block = tile.blocks[entry];
  for (std::uint32_t t = 0; t < cluster.triangleCount; ++t) {
    if (batch.isReplaced(cluster.firstTriangle + t)) continue;
    Corners corners;
    const float* planes[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint8_t i = set.corners[k][cluster.firstTriangle + t];
      corners.x[k] = block.x[i], corners.y[k] = block.y[i];
      planes[k] = block.plane[i];
    }
    TriangleSetup setup;
    if (setup.set(tile, corners, planes, entry * kClusterTriangles + t, batch.mirrored, doubleSided))
      drawTriangle(tile, setup);
  }
}

void drawLooseScalar(Tile& tile, std::uint32_t item) {
  TriangleSetup setup;
  if (setLoose(tile, item, setup)) drawTriangle(tile, setup);
}

void resolveVisibility(Tile& tile) {
  const Kernels& kernels = tile.context->kernels;
  for (std::uint32_t entry = 0; entry < tile.clusters.size(); ++entry) {
    const VisibleCluster& visible = tile.context->front.cluster(tile.clusters[entry]);
    const Batch& batch = tile.context->batches[visible.batch];
    kernels.transformCluster(batch, batch.set->clusters[visible.cluster], tile.context->map,
                             tile.blocks[entry]);
    tile.clock.lap(tile.statistics.transformMs);
    drawClusterScalar(tile, entry);
    tile.clock.lap(tile.statistics.visibilityMs);
  }
  for (const std::uint32_t item : tile.loose) drawLooseScalar(tile, item);
}

}  // namespace limn::raster
