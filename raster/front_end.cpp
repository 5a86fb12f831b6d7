#include "raster/front_end.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "raster/kernels.h"
#include "raster/numbers.h"

namespace limn::raster {
namespace {

enum class Fate { kHidden, kWhole, kClip };

// All triangles face away, by more than snapping to the grid could turn round.
bool facesAway(const ClusterBounds& c, const Batch& batch, bool perspective) {
  constexpr float kMargin = 0.02F;
  if (!perspective)
    return -dot(c.coneAxis, batch.eye) >= (c.coneSine + kMargin) * std::sqrt(dot(batch.eye, batch.eye));
  const glm::vec3 d = c.center - batch.eye;
  return dot(d, c.coneAxis) >= (c.coneSine + kMargin) * std::sqrt(dot(d, d)) + c.radius;
}

// How far rounding may put two points of a cluster from where they are to each other in view space: Affine's terms can
// be much larger than their sum.
float roundingOf(const ClusterBounds& bounds, const Batch& batch) {
  constexpr float kRootOfThree = 1.75F;  // and more
  const auto most = [](float x, float y, float z) {
    return std::max(std::max(std::fabs(x), std::fabs(y)), std::fabs(z));
  };
  const auto& m = batch.toView.m;
  const float reach = most(bounds.center.x, bounds.center.y, bounds.center.z) + bounds.radius;
  return (reach * (batch.stretch * kRootOfThree) + most(m[0][3], m[1][3], m[2][3])) * 5e-7F;
}

Fate classify(const ClusterBounds& bounds, const Batch& batch, const ScreenMap& map) {
  const glm::vec3 c = batch.toView(bounds.center.x, bounds.center.y, bounds.center.z);
  const float size = (std::fabs(c.x) + std::fabs(c.y)) + std::fabs(c.z);
  const float r = bounds.radius * batch.stretch + (size * 1e-5F + roundingOf(bounds, batch));
  const float nearest = -c.z - r, farthest = -c.z + r;
  if (!(farthest >= map.nearPlane) || nearest > map.farPlane) return Fate::kHidden;
  if (!(nearest > map.nearPlane) || farthest > map.farPlane) return Fate::kClip;
  // The sphere's box in view space, projected; the window's own edges are left to the exact box.
  const float wide = map.perspective ? 1.0F / nearest : 1.0F,
              narrow = map.perspective ? 1.0F / farthest : 1.0F;
  const float halfX = map.offsetX + (kGuardPixels - 2.0F) * kSubpixels;
  const float halfY = map.offsetY + (kGuardPixels - 2.0F) * kSubpixels;
  const auto low = [&](float v) { return v < 0.0F ? v * wide : v * narrow; };
  const auto high = [&](float v) { return v < 0.0F ? v * narrow : v * wide; };
  const float sy = -map.scaleY;
  const float x0 = low(c.x - r) * map.scaleX, x1 = high(c.x + r) * map.scaleX;
  const float y0 = low(c.y - r) * sy, y1 = high(c.y + r) * sy;
  if (x1 < -map.offsetX || x0 > map.offsetX || y1 < -map.offsetY || y0 > map.offsetY) return Fate::kHidden;
  return x0 > -halfX && x1 < halfX && y0 > -halfY && y1 < halfY ? Fate::kWhole : Fate::kClip;
}

}  // namespace

Tiling::Tiling(int windowWidth, int windowHeight, int tw, int th)
    : tileWidth(tw),
      tileHeight(th),
      columns((windowWidth + tw - 1) / tw),
      rows((windowHeight + th - 1) / th),
      width(windowWidth),
      height(windowHeight) {}

TileRect tilesOf(const Box& box, const Tiling& tiling) {
  const std::int32_t x0 = std::max(box.minX >> kSubpixelBits, 0), y0 = std::max(box.minY >> kSubpixelBits, 0);
  const std::int32_t x1 = std::min(box.maxX >> kSubpixelBits, tiling.width - 1);
  const std::int32_t y1 = std::min(box.maxY >> kSubpixelBits, tiling.height - 1);
  if (x0 > x1 || y0 > y1) return {0, 0, 0, 0};
  return {static_cast<std::uint16_t>(x0 / tiling.tileWidth),
          static_cast<std::uint16_t>(y0 / tiling.tileHeight),
          static_cast<std::uint16_t>(x1 / tiling.tileWidth + 1),
          static_cast<std::uint16_t>(y1 / tiling.tileHeight + 1)};
}

void Bins::reset(const Tiling& tiling) {
  columns_ = static_cast<std::size_t>(tiling.columns);
  tiles_ = tiling.count();
  cursors_.assign(kRanges * tiles_, 0);
  starts_.resize(tiles_ + 1);
}

void Bins::count(std::size_t range, const TileRect& rect) {
  for (std::size_t y = rect.y0; y < rect.y1; ++y)
    for (std::size_t x = rect.x0; x < rect.x1; ++x) ++cursors_[range * tiles_ + y * columns_ + x];
}

void Bins::allocate() {
  std::uint64_t next = 0;
  for (std::size_t tile = 0; tile < tiles_; ++tile) {
    const std::uint64_t first = next;
    starts_[tile] = static_cast<std::uint32_t>(first);
    for (std::size_t range = 0; range < kRanges; ++range) {
      const std::uint32_t count = cursors_[range * tiles_ + tile];
      cursors_[range * tiles_ + tile] = static_cast<std::uint32_t>(next);
      next += count;
    }
    if (next > kMostItems || next - first > kMostOfTile)
      throw std::length_error("the frame's clusters, triangles and lines lie in too many tiles");
  }
  starts_[tiles_] = static_cast<std::uint32_t>(next);
  if (items_.size() < next) items_.resize(next);
}

void Bins::place(std::size_t range, const TileRect& rect, std::uint32_t item) {
  for (std::size_t y = rect.y0; y < rect.y1; ++y)
    for (std::size_t x = rect.x0; x < rect.x1; ++x)
      items_[cursors_[range * tiles_ + y * columns_ + x]++] = item;
}

std::size_t Bins::memoryBytes() const {
  return (cursors_.capacity() + starts_.capacity() + items_.capacity()) * sizeof(std::uint32_t);
}

void FrontEnd::cullRange(const Frame& frame, std::span<const Batch> batches, const ScreenMap& map,
                         const Tiling& tiling, const Kernels& kernels, Range& range) {
  auto batch = std::upper_bound(batches.begin(), batches.end(), range.begin,
                                [](std::size_t i, const Batch& b) { return i < b.firstCluster; }) -
               1;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    while (i - batch->firstCluster >= batch->set->clusters.size()) ++batch;
    const auto c = static_cast<std::uint32_t>(i - batch->firstCluster);
    const auto b = static_cast<std::uint32_t>(batch - batches.begin());
    const Cluster& cluster = batch->set->clusters[c];
    const ClusterBounds& bounds = batch->bounds[c];
    const bool cones = batch->conesHold && !frame.materials[cluster.material].doubleSided;
    if (cones && bounds.coneSine < 1.0F && facesAway(bounds, *batch, map.perspective)) continue;
    const Fate fate = classify(bounds, *batch, map);
    if (fate == Fate::kHidden || batch->isReplaced(cluster)) continue;
    const bool blended = frame.materials[cluster.material].alphaMode == AlphaMode::kBlend;
    if (fate == Fate::kClip || blended) {
      drawLoosely(*batch, b, c, blended, map, range);
      continue;
    }
    const TileRect rect = tilesOf(kernels.boxOfCluster(*batch, cluster, map), tiling);
    if (rect.empty()) continue;
    visible_[range.begin + range.visible++] = {b, c, rect};
  }
}

void FrontEnd::drawLoosely(const Batch& batch, std::uint32_t b, std::uint32_t c, bool blended,
                           const ScreenMap& map, Range& range) {
  const Cluster& cluster = batch.set->clusters[c];
  for (std::uint32_t t = 0; t < cluster.triangleCount; ++t) {
    const std::uint32_t triangle = cluster.firstTriangle + t;
    if (batch.isReplaced(triangle)) continue;
    const std::size_t first = range.loose.size();
    clipTriangle(batch, {b, c, t}, map, range.loose);
    if (!blended) continue;
    float z[3];
    for (std::size_t k = 0; k < 3; ++k)
      z[k] = viewPosition(batch, cluster.firstVertex + batch.set->corners[k][triangle]).z;
    const float depth = -((z[0] + z[1]) + z[2]);
    for (std::size_t i = first; i < range.loose.size(); ++i)
      range.blended.push_back({depth, batch.order(triangle), static_cast<std::uint32_t>(i)});
  }
}

void FrontEnd::cull(const Frame& frame, std::span<const Batch> batches, std::size_t clusterCount,
                    const ScreenMap& map, const Tiling& tiling, const Kernels& kernels, Workers& workers) {
  if (visible_.size() < clusterCount) visible_.resize(clusterCount);
  workers.forBlocks(kRanges, 1, [&](std::size_t r, std::size_t, int) {
    Range& range = ranges_[r];
    range.begin = clusterCount * r / kRanges;
    range.end = clusterCount * (r + 1) / kRanges;
    range.visible = 0;
    range.loose.clear();
    range.blended.clear();
    if (range.begin < range.end) cullRange(frame, batches, map, tiling, kernels, range);
  });
  gatherLoose(workers);
  sortBlended();
}

void FrontEnd::gatherLoose(Workers& workers) {
  std::size_t count = 0;
  for (Range& range : ranges_) {
    range.firstLoose = count;
    count += range.loose.size();
  }
  if (count == 0) return;
  if (loose_.size() < count) loose_.resize(count);
  workers.forBlocks(kRanges, 1, [&](std::size_t r, std::size_t, int) {
    const Range& range = ranges_[r];
    std::copy(range.loose.begin(), range.loose.end(),
              loose_.begin() + static_cast<std::ptrdiff_t>(range.firstLoose));
  });
}

void FrontEnd::sortBlended() {
  blended_.clear();
  for (const Range& range : ranges_)
    for (const BlendKey& key : range.blended)
      blended_.push_back({key.depth, key.order, static_cast<std::uint32_t>(range.firstLoose + key.loose)});
  std::sort(blended_.begin(), blended_.end());
}

void FrontEnd::bin(const Tiling& tiling, Workers& workers) {
  const std::array<Bins*, 3> all{&clusterBins_, &looseBins_, &blendedBins_};
  const auto forRanges = [&](const auto& body) {
    workers.forBlocks(kRanges, 1, [&](std::size_t r, std::size_t, int) { forItems(tiling, r, body); });
  };
  for (Bins* bins : all) bins->reset(tiling);
  forRanges([](Bins& bins, std::size_t r, const TileRect& rect, std::size_t) { bins.count(r, rect); });
  for (Bins* bins : all) bins->allocate();
  forRanges([](Bins& bins, std::size_t r, const TileRect& rect, std::size_t item) {
    bins.place(r, rect, static_cast<std::uint32_t>(item));
  });
}

// Calls body(bins, r, tiles, item) for all that a range puts into lists.
template <class Body>
void FrontEnd::forItems(const Tiling& tiling, std::size_t r, const Body& body) {
  const Range& range = ranges_[r];
  const auto tilesOfLoose = [&](std::size_t i) { return tilesOf(boxOf(loose_[i].corners), tiling); };
  for (std::size_t i = range.begin; i < range.begin + range.visible; ++i)
    body(clusterBins_, r, visible_[i].tiles, i);
  auto key = range.blended.begin();
  for (std::size_t i = 0; i < range.loose.size(); ++i) {
    if (key != range.blended.end() && key->loose == i)
      ++key;  // has its place among the blended ones
    else
      body(looseBins_, r, tilesOfLoose(range.firstLoose + i), range.firstLoose + i);
  }
  for (std::size_t i = blended_.size() * r / kRanges; i < blended_.size() * (r + 1) / kRanges; ++i)
    body(blendedBins_, r, tilesOfLoose(blended_[i].loose), blended_[i].loose);
}

std::size_t FrontEnd::memoryBytes() const {
  std::size_t bytes = visible_.capacity() * sizeof(VisibleCluster) +
                      loose_.capacity() * sizeof(LooseTriangle) + blended_.capacity() * sizeof(BlendKey) +
                      clusterBins_.memoryBytes() + looseBins_.memoryBytes() + blendedBins_.memoryBytes();
  for (const Range& range : ranges_)
    bytes += range.loose.capacity() * sizeof(LooseTriangle) + range.blended.capacity() * sizeof(BlendKey);
  return bytes;
}

}  // namespace limn::raster
