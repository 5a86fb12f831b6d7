// Times are those of one thread, measured with layers of large triangles: an estimate within a factor of two or so.
#include "raster/effort.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "raster/kernels.h"

namespace limn::raster {
namespace {

/// Nanoseconds per pixel of a triangle.
struct Rates {
  double drawing;  ///< whatever hides the pixel
  double shading;  ///< where it is seen
};

Rates ratesOf(const Material& m, std::span<const Light> lights) {
  constexpr double kOpaque = 12.0, kMasked = 55.0, kBlended = 80.0, kTexel = 90.0;
  constexpr double kVectorLight = 2.5, kScalarLight = 30.0;
  const bool complex = m.normalTexture != nullptr || m.emissiveTexture != nullptr;
  const bool blended = m.alphaMode == AlphaMode::kBlend, masked = m.alphaMode == AlphaMode::kMask;
  double texels = 0.0;
  for (const Texture* texture : {m.baseColorTexture, m.normalTexture, m.emissiveTexture})
    if (texture != nullptr) texels += kTexel;
  const double lit = m.unlit ? 0.0 : static_cast<double>(lights.size());
  const double shading = texels + lit * (blended || complex ? kScalarLight : kVectorLight);
  if (blended) return {kBlended + shading, 0.0};
  if (!masked) return {kOpaque, shading};
  return {kMasked + (m.baseColorTexture != nullptr ? kTexel : 0.0), shading};
}

/// The pixels of the window that a box of sub-pixels touches.
struct WindowBox {
  double width, height;

  WindowBox(const Box& box, const ScreenMap& map)
      : width(extent(box.minX, box.maxX, map.width)), height(extent(box.minY, box.maxY, map.height)) {}
  double pixels() const { return width * height; }

 private:
  static double extent(std::int32_t low, std::int32_t high, int size) {
    const int first = std::max(low >> kSubpixelBits, 0), last = std::min(high >> kSubpixelBits, size - 1);
    return first <= last ? last - first + 1 : 0;
  }
};

/// Pixels that are looked at to draw a triangle.
double pixelsOf(const Corners& c, const ScreenMap& map) {
  constexpr double kTwiceAPixel = 2.0 * kSubpixels * kSubpixels;
  const WindowBox box(boxOf(c), map);
  const double area = static_cast<double>(std::abs(signedArea(c))) / kTwiceAPixel;
  return std::min(box.pixels(), area + box.width + box.height);
}

class Estimate {
 public:
  Estimate(const Frame& frame, std::span<const Batch> batches, const FrontEnd& front, const ScreenMap& map)
      : frame_(frame), batches_(batches), front_(front), map_(map) {}

  /// Never less than the effort. Allocates nothing.
  double upperBound(const Tiling& tiling) {
    for (std::size_t r = 0; r < kRanges; ++r)
      for (const VisibleCluster& v : front_.visibleOf(r)) {
        const TileRect& t = v.tiles;
        const double tiles = double(t.x1 - t.x0) * double(t.y1 - t.y0);
        const Cluster& cluster = clusterOf(v);
        add(v.batch, cluster.material, cluster.triangleCount * tiles * tiling.tileWidth * tiling.tileHeight);
      }
    addLoose();
    return total();
  }

  double exact(const Kernels& kernels, Workers& workers) {
    ofDraw_.resize(frame_.draws.size(), 0.0);
    drawing_ = shading_ = worstShading_ = 0.0;
    std::vector<double> pixels;
    for (std::size_t r = 0; r < kRanges; ++r) {
      const std::span<const VisibleCluster> visible = front_.visibleOf(r);
      pixels.resize(visible.size());
      workers.forBlocks(visible.size(), kGrain, [&](std::size_t first, std::size_t last, int) {
        VertexBlock block;
        for (std::size_t i = first; i < last; ++i) pixels[i] = pixelsOfCluster(visible[i], kernels, block);
      });
      for (std::size_t i = 0; i < visible.size(); ++i)
        add(visible[i].batch, clusterOf(visible[i]).material, pixels[i]);
    }
    addLoose();
    return total();
  }

  /// The draw that takes the most of what exact() counted.
  std::uint32_t heaviestDraw() const {
    return static_cast<std::uint32_t>(std::max_element(ofDraw_.begin(), ofDraw_.end()) - ofDraw_.begin());
  }

 private:
  static constexpr std::size_t kGrain = 64;

  const Cluster& clusterOf(const VisibleCluster& v) const {
    return batches_[v.batch].set->clusters[v.cluster];
  }

  void add(std::uint32_t batch, std::uint32_t material, double pixels) {
    const Rates rates = ratesOf(frame_.materials[material], frame_.lights);
    if (!ofDraw_.empty()) ofDraw_[batches_[batch].drawIndex] += pixels * (rates.drawing + rates.shading);
    drawing_ += pixels * rates.drawing;
    shading_ += pixels * rates.shading;
    if (pixels > 0.0) worstShading_ = std::max(worstShading_, rates.shading);
  }

  void addLoose() {
    for (std::size_t i = 0; i < front_.looseCount(); ++i) {
      const LooseTriangle& t = front_.loose(static_cast<std::uint32_t>(i));
      const Cluster& cluster = batches_[t.ref.batch].set->clusters[t.ref.cluster];
      if (isDrawn(t.corners, t.ref.batch, cluster))
        add(t.ref.batch, cluster.material, pixelsOf(t.corners, map_));
    }
  }

  /// What is hidden is not shaded: at most every sample of the window.
  double total() const {
    const double samples = double(map_.width) * double(map_.height) * frame_.samples;
    return drawing_ + std::min(shading_, samples * worstShading_);
  }

  bool isDrawn(const Corners& c, std::uint32_t batch, const Cluster& cluster) const {
    const std::int64_t area = signedArea(c);
    const bool back = facesAway(area, batches_[batch].mirrored);
    return area != 0 && (!back || frame_.materials[cluster.material].doubleSided);
  }

  double pixelsOfCluster(const VisibleCluster& v, const Kernels& kernels, VertexBlock& block) const {
    const Batch& batch = batches_[v.batch];
    const Cluster& cluster = clusterOf(v);
    kernels.transformCluster(batch, cluster, map_, block);
    double pixels = 0.0;
    for (std::uint32_t t = cluster.firstTriangle; t < cluster.firstTriangle + cluster.triangleCount; ++t) {
      if (batch.isReplaced(t)) continue;
      Corners c;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint8_t i = batch.set->corners[k][t];
        c.x[k] = block.x[i], c.y[k] = block.y[i];
      }
      if (isDrawn(c, v.batch, cluster)) pixels += pixelsOf(c, map_);
    }
    return pixels;
  }

  const Frame& frame_;
  std::span<const Batch> batches_;
  const FrontEnd& front_;
  const ScreenMap& map_;
  std::vector<double> ofDraw_;  // of exact()
  double drawing_ = 0.0, shading_ = 0.0, worstShading_ = 0.0;
};

}  // namespace

void requireEffortWithinLimit(const Frame& frame, std::span<const Batch> batches, const FrontEnd& front,
                              const ScreenMap& map, const Tiling& tiling, const Kernels& kernels,
                              Workers& workers) {
  if (!std::isfinite(frame.effortLimit)) return;
  Estimate estimate(frame, batches, front, map);
  if (estimate.upperBound(tiling) <= frame.effortLimit) return;
  const double effort = estimate.exact(kernels, workers);
  if (effort > frame.effortLimit) throw TooMuchEffort(effort, estimate.heaviestDraw());
}

}  // namespace limn::raster
