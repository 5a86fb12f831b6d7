// The first half of a frame: which clusters may be seen, and in which tiles.
//
// Work is cut into a fixed number of ranges of clusters, whatever the number of threads; every tile's list is
// in the order of submission.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/base/workers.h"
#include "raster/batch.h"
#include "raster/clip.h"

namespace limn::raster {

struct Kernels;

inline constexpr std::size_t kRanges = 32;

/// The window cut into tiles.
struct Tiling {
  int tileWidth, tileHeight, columns, rows, width, height;
  Tiling(int windowWidth, int windowHeight, int tileWidth, int tileHeight);
  std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Tiles [x0, x1) × [y0, y1).
struct TileRect {
  std::uint16_t x0, y0, x1, y1;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};
TileRect tilesOf(const Box& box, const Tiling& tiling);

/// Lists of items by tile: counted by all ranges, then placed by all ranges.
class Bins {
 public:
  /// What the lists may hold; 1 GiB. Records number the clusters of a tile in 24 bits.
  static constexpr std::uint64_t kMostItems = 1U << 28U, kMostOfTile = 1U << 24U;

  void reset(const Tiling& tiling);
  void count(std::size_t range, const TileRect& rect);
  /// Between counting and placing. Throws std::length_error if there are too many items.
  void allocate();
  void place(std::size_t range, const TileRect& rect, std::uint32_t item);
  std::span<const std::uint32_t> of(std::size_t tile) const {
    return {items_.data() + starts_[tile], items_.data() + starts_[tile + 1]};
  }
  std::size_t memoryBytes() const;

 private:
  std::size_t columns_ = 0, tiles_ = 0;
  std::vector<std::uint32_t> cursors_;  // range · tiles + tile
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> items_;
};

/// A cluster that may be seen.
struct VisibleCluster {
  std::uint32_t batch, cluster;
  TileRect tiles;
};

class FrontEnd {
 public:
  /// Finds the clusters that may be seen and where, and cuts up those that are drawn as loose triangles.
  void cull(const Frame& frame, std::span<const Batch> batches, std::size_t clusterCount,
            const ScreenMap& map, const Tiling& tiling, const Kernels& kernels, Workers& workers);
  /// Puts all that into the lists of the tiles. Apart, since a frame that is refused need not have them.
  void bin(const Tiling& tiling, Workers& workers);

  const VisibleCluster& cluster(std::uint32_t item) const { return visible_[item]; }
  /// The clusters of a range that may be seen.
  std::span<const VisibleCluster> visibleOf(std::size_t range) const {
    return std::span(visible_).subspan(ranges_[range].begin, ranges_[range].visible);
  }
  const LooseTriangle& loose(std::uint32_t item) const { return loose_[item]; }
  std::size_t looseCount() const { return ranges_.back().firstLoose + ranges_.back().loose.size(); }
  const Bins& clusterBins() const { return clusterBins_; }
  const Bins& looseBins() const { return looseBins_; }
  const Bins& blendedBins() const { return blendedBins_; }  ///< loose triangles, far to near
  std::size_t memoryBytes() const;

 private:
  struct BlendKey {
    float depth;  ///< three times the view depth of the triangle's centre
    std::uint64_t order;
    std::uint32_t loose;
    bool operator<(const BlendKey& other) const {
      if (depth != other.depth) return depth > other.depth;
      return order != other.order ? order < other.order : loose < other.loose;
    }
  };
  struct Range {
    std::size_t begin = 0, end = 0, visible = 0, firstLoose = 0;
    std::vector<LooseTriangle> loose;
    std::vector<BlendKey> blended;  ///< which of `loose` are blended
  };
  void cullRange(const Frame& frame, std::span<const Batch> batches, const ScreenMap& map,
                 const Tiling& tiling, const Kernels& kernels, Range& range);
  void drawLoosely(const Batch& batch, std::uint32_t b, std::uint32_t c, bool blended, const ScreenMap& map,
                   Range& range);
  void gatherLoose(Workers& workers);
  void sortBlended();
  template <class Body>
  void forItems(const Tiling& tiling, std::size_t r, const Body& body);

  std::array<Range, kRanges> ranges_;
  std::vector<VisibleCluster> visible_;  // of range r at [ranges_[r].begin, + visible)
  std::vector<LooseTriangle> loose_;
  std::vector<BlendKey> blended_;
  Bins clusterBins_, looseBins_, blendedBins_;
};

}  // namespace limn::raster
