#include "raster/tile.h"

#include <algorithm>

#include "raster/base/scratch.h"

namespace limn::raster {

void Tile::begin(const FrameContext& c, std::size_t index) {
  context = &c;
  clock = StageClock::started(c.timed);
  const Tiling& tiling = c.tiling;
  const auto columns = static_cast<std::size_t>(tiling.columns);
  left = static_cast<int>(index % columns) * tiling.tileWidth;
  top = static_cast<int>(index / columns) * tiling.tileHeight;
  width = std::min(tiling.tileWidth, tiling.width - left);
  height = std::min(tiling.tileHeight, tiling.height - top);
  stride = tiling.tileWidth + kRowPadding;
  clusters = c.front.clusterBins().of(index);
  loose = c.front.looseBins().of(index);
  blended = c.front.blendedBins().of(index);
  plane = static_cast<std::size_t>(stride) * static_cast<std::size_t>(tiling.tileHeight) + kPlanePadding;
  const std::size_t samples = c.samples.size() * plane;
  depth.assign(samples, kNoDepth);
  ids.assign(samples, kNoRecord);
  for (std::vector<float>& component : normal) component.resize(plane);
  if (c.samples.size() > 1) centerDepth.resize(plane);
  sampleRange = {kSubpixels, 0};
  for (const SamplePosition at : c.samples) {
    sampleRange.low = std::min({sampleRange.low, at.x, at.y});
    sampleRange.high = std::max({sampleRange.high, at.x, at.y});
  }
  recordCount = 0;
  attributes.clear();
  lines = c.lines.of(index);
  overlaid = !blended.empty() || !lines.empty();
  if (overlaid) {
    colors.resize(samples);
    isBlended.assign(plane, 0);
  }
  if (blocks.size() < clusters.size()) blocks.resize(clusters.size());
  surfaces.clear();
  for (const std::uint32_t item : clusters)
    surfaces.push_back(surfaceOf(c.front.cluster(item).batch, c.front.cluster(item).cluster));
  plainMaterial = loose.empty() && !surfaces.empty() ? surfaces[0].material : nullptr;
  for (const Surface& s : surfaces) {
    const Material& m = *s.material;
    const bool textured =
        m.baseColorTexture != nullptr || m.normalTexture != nullptr || m.emissiveTexture != nullptr;
    if (&m != plainMaterial || s.hasColors || textured) plainMaterial = nullptr;
  }
}

Surface Tile::surfaceOf(std::uint32_t b, std::uint32_t cluster) const {
  const Batch& batch = context->batches[b];
  const Draw& draw = *batch.draw;
  const bool hasColors = !draw.geometry->data().colors.empty() || !draw.stream.vertices.colors.empty();
  return {&batch, &context->frame.materials[batch.set->clusters[cluster].material], hasColors};
}

TriangleRef Tile::refOf(const Record& record) const {
  if ((record.source & Record::kLoose) != 0) return context->front.loose(record.source & ~Record::kLoose).ref;
  const VisibleCluster& v = context->front.cluster(clusters[record.source / kClusterTriangles]);
  return {v.batch, v.cluster, record.source % kClusterTriangles};
}

Corners Tile::cornersOf(const Record& record, std::array<int, 3>& order) const {
  Corners c;
  if ((record.source & Record::kLoose) != 0) {
    const LooseTriangle& t = context->front.loose(record.source & ~Record::kLoose);
    std::copy(t.x, t.x + 3, c.x);
    std::copy(t.y, t.y + 3, c.y);
  } else {
    const TriangleRef ref = refOf(record);
    const ClusterSet& set = *context->batches[ref.batch].set;
    const VertexBlock& block = blocks[record.source / kClusterTriangles];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint8_t i = set.corners[k][set.clusters[ref.cluster].firstTriangle + ref.triangle];
      c.x[k] = block.x[i], c.y[k] = block.y[i];
    }
  }
  order = {0, 1, 2};
  if (signedArea(c) < 0) {
    std::swap(c.x[1], c.x[2]);
    std::swap(c.y[1], c.y[2]);
    order = {0, 2, 1};
  }
  return c;
}

std::uint64_t Tile::orderOf(const Record& record) const {
  const TriangleRef ref = refOf(record);
  const Batch& batch = context->batches[ref.batch];
  return batch.order(batch.set->clusters[ref.cluster].firstTriangle + ref.triangle);
}

void Tile::levelMemory(std::vector<Tile>& tiles) {
  levelCapacity(tiles, &Tile::depth, &Tile::ids, &Tile::centerDepth, &Tile::records, &Tile::corners,
                &Tile::attributes, &Tile::surfaces, &Tile::blocks, &Tile::colors, &Tile::isBlended);
  for (std::size_t k = 0; k < 3; ++k)
    levelCapacity(tiles, [k](Tile& tile) -> std::vector<float>& { return tile.normal[k]; });
}

std::size_t Tile::memoryBytes() const {
  return (depth.capacity() + 3 * normal[0].capacity() + centerDepth.capacity()) * sizeof(float) +
         ids.capacity() * sizeof(std::uint32_t) + records.capacity() * sizeof(Record) +
         corners.capacity() * sizeof(Corners) + blocks.capacity() * sizeof(VertexBlock) +
         surfaces.capacity() * sizeof(Surface) + attributes.capacity() * sizeof(Attributes) +
         colors.capacity() * sizeof(glm::vec4) + isBlended.capacity();
}

}  // namespace limn::raster
