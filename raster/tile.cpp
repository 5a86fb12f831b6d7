#include "raster/tile.h"

#include <algorithm>
#include <cstring>

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
  clusters = c.front.clusterBins().of(index);
  loose = c.front.looseBins().of(index);
  blended = c.front.blendedBins().of(index);
  strip = static_cast<std::size_t>(tiling.tileHeight) * kStripWidth + kStripPadding;
  plane = static_cast<std::size_t>(tiling.tileWidth) / kStripWidth * strip;
  const std::size_t samples = c.samples.size() * plane;
  depth.resize(samples);
  ids.resize(samples);
  touched_ = 0;
  for (std::vector<float>& component : normal) component.resize(plane);
  if (hasSeveralSamples()) centers.resize(4 * plane);
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
  const Target& target = c.target;
  if (overlaid || target.depth != nullptr || target.normals != nullptr || target.ids != nullptr)
    touch(0, 0, width, height);
  if (blocks.size() < clusters.size()) blocks.resize(clusters.size());
  surfaces.clear();
  for (const std::uint32_t item : clusters)
    surfaces.push_back(surfaceOf(c.front.cluster(item).batch, c.front.cluster(item).cluster));
  setSoleMaterial();
}

void Tile::setSoleMaterial() {
  plainMaterial = texturedMaterial = nullptr;
  if (!loose.empty() || surfaces.empty()) return;
  const Material& m = *surfaces[0].material;
  for (const Surface& s : surfaces)
    if (s.material != &m || s.hasColors) return;
  if (m.normalTexture != nullptr || m.emissiveTexture != nullptr) return;
  if (m.baseColorTexture == nullptr)
    plainMaterial = &m;
  else if (m.alphaMode != AlphaMode::kMask)
    texturedMaterial = &m;
}

void Tile::clear(std::uint64_t cells) {
  touched_ |= cells;
  const std::size_t count = (hasSeveralSamples() ? kGroup : 1) * kCellWidth;
  const int groups = std::max(1, static_cast<int>(context->samples.size() / kGroup));
  for (; cells != 0; cells &= cells - 1) {
    const int cell = std::countr_zero(cells), x = cell % 8 * kCellWidth, y = cell / 8 * kCellHeight;
    const std::size_t size = count * static_cast<std::size_t>(std::min(kCellHeight, height - y));
    for (int g = 0; g < groups; ++g) {
      const std::size_t o = offset(g * static_cast<int>(kGroup), x, y);
      std::memset(&depth[o], kNoDepthByte, size * sizeof(float));
      std::memset(&ids[o], 0xff, size * sizeof(std::uint32_t));
    }
  }
}

Surface Tile::surfaceOf(std::uint32_t b, std::uint32_t cluster) const {
  const Batch& batch = context->batches[b];
  const Draw& draw = *batch.draw;
  const bool hasColors =
      !draw.geometry->data().vertices.colors.empty() || !draw.stream.vertices.colors.empty();
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
    c = context->front.loose(record.source & ~Record::kLoose).corners;
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

CenterEdges Tile::centerEdgesOf(const Corners& drawn) const {
  CenterEdges result{};
  const std::int32_t px = left * kSubpixels + kOneSample[0].x, py = top * kSubpixels + kOneSample[0].y;
  for (int k = 0; k < 3; ++k) {
    const Edge edge = Edge::of(drawn, k, k == 2 ? 0 : k + 1);
    const std::int64_t value = edge.at(px, py) >> kSubpixelBits;
    const std::int64_t acrossX = -static_cast<std::int64_t>(edge.dy) * (width - 1),
                       acrossY = static_cast<std::int64_t>(edge.dx) * (height - 1);
    // Where an edge crosses the tile, its values in it fit 32 bits.
    if (value + std::min<std::int64_t>(acrossX, 0) + std::min<std::int64_t>(acrossY, 0) >= 0) continue;
    result.value[k] = static_cast<std::int32_t>(value);
    result.stepX[k] = -edge.dy;
    result.stepY[k] = edge.dx;
  }
  return result;
}

std::uint64_t Tile::orderOf(const Record& record) const {
  const TriangleRef ref = refOf(record);
  const Batch& batch = context->batches[ref.batch];
  return batch.order(batch.set->clusters[ref.cluster].firstTriangle + ref.triangle);
}

void Tile::levelMemory(std::vector<Tile>& tiles) {
  levelCapacity(tiles, &Tile::depth, &Tile::ids, &Tile::centers, &Tile::records, &Tile::centerEdges,
                &Tile::texturePlanes, &Tile::attributes, &Tile::surfaces, &Tile::blocks, &Tile::colors,
                &Tile::isBlended);
  for (std::size_t k = 0; k < 3; ++k)
    levelCapacity(tiles, [k](Tile& tile) -> std::vector<float>& { return tile.normal[k]; });
}

std::size_t Tile::memoryBytes() const {
  return (depth.capacity() + 3 * normal[0].capacity() + centers.capacity()) * sizeof(float) +
         ids.capacity() * sizeof(std::uint32_t) + records.capacity() * sizeof(Record) +
         centerEdges.capacity() * sizeof(CenterEdges) + texturePlanes.capacity() * sizeof(TexturePlanes) +
         blocks.capacity() * sizeof(VertexBlock) + surfaces.capacity() * sizeof(Surface) +
         attributes.capacity() * sizeof(Attributes) + colors.capacity() * sizeof(glm::vec4) +
         isBlended.capacity();
}

}  // namespace limn::raster
