// What the owner of a tile works in: depth and triangle per sample, and the triangles that were seen.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "raster/clip.h"
#include "raster/front_end.h"
#include "raster/lines.h"
#include "raster/samples.h"
#include "raster/stage_clock.h"
#include "raster/transform.h"
#include "raster/triangle.h"

namespace limn::raster {

struct Kernels;

/// All of a frame that tiles read.
struct FrameContext {
  const Frame& frame;
  const Target& target;
  const ScreenMap& map;
  const Tiling& tiling;
  std::span<const Batch> batches;
  const FrontEnd& front;
  std::span<const SamplePosition> samples;
  const Kernels& kernels;
  const LineBins& lines;
  bool timed;  ///< somebody wants to know how long stages take
};

inline constexpr int kMaxSamples = 8;
inline constexpr std::uint32_t kNoRecord = 0xffffffffU;
/// Of an empty sample. What lies beyond the far plane is cut off, so whatever covers a sample is nearer than
/// nothing, even where its depth is rounding noise.
inline constexpr float kNoDepth = std::numeric_limits<float>::lowest();

/// A triangle that won at least one sample, or a micro triangle that covers one: the planes of its normal · q and depth, and where it comes from.
struct alignas(64) Record {
  float origin[4], slopeX[4], slopeY[4];
  std::int32_t x0, y0;   ///< where the planes are anchored
  std::uint32_t source;  ///< cluster of the tile · kClusterTriangles + triangle, or kLoose + loose triangle
  std::uint32_t attributes;  ///< index into Tile::attributes, or kNoRecord: not asked for yet

  static constexpr std::uint32_t kLoose = 0x80000000U;

  float value(int i, std::int32_t x, std::int32_t y) const {
    return (origin[i] + slopeY[i] * static_cast<float>(y - y0)) + slopeX[i] * static_cast<float>(x - x0);
  }
};

/// The planes of what else materials interpolate, each value times q.
struct Attributes {
  enum { kU, kV, kRed, kGreen, kBlue, kAlpha, kTangentX, kTangentY, kTangentZ, kCount };
  float origin[kCount], slopeX[kCount], slopeY[kCount];
  float handedness;  ///< of the tangent frame
  bool isBackFace;
};

/// The batch and the material that a triangle is drawn with.
struct Surface {
  const Batch* batch;
  const Material* material;
  bool hasColors;  ///< some vertex has
};

/// One thread's memory for tiles, used again from tile to tile and frame to frame.
class Tile {
 public:
  /// Empties the tile at column, row of the tiling.
  void begin(const FrameContext& context, std::size_t index);

  /// Nothing is drawn in it.
  bool isEmpty() const { return clusters.empty() && loose.empty() && !overlaid; }
  std::size_t offset(int sample, int x, int y) const {  ///< x, y from the tile's corner
    return static_cast<std::size_t>(sample) * plane +
           static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
  }
  /// Where a record's triangle comes from.
  TriangleRef refOf(const Record& record) const;
  Surface surfaceOf(const Record& record) const {
    if ((record.source & Record::kLoose) == 0) return surfaces[record.source / kClusterTriangles];
    const TriangleRef ref = refOf(record);
    return surfaceOf(ref.batch, ref.cluster);
  }
  /// Its corners on the sub-pixel grid, in drawing order; indices[i] says which corner of the triangle they
  /// are.
  Corners cornersOf(const Record& record, std::array<int, 3>& order) const;
  Corners cornersOf(const Record& record) const {
    std::array<int, 3> order;
    return cornersOf(record, order);
  }
  /// Keeps a record and returns its number.
  std::uint32_t add(const Record& record, const Corners& drawn) {
    reserveRecords(1);
    records[recordCount] = record;
    if (keepsCorners()) corners[recordCount] = drawn;
    return recordCount++;
  }
  /// Makes room for so many more.
  void reserveRecords(std::size_t count) {
    grow(records, recordCount + count);
    if (keepsCorners()) grow(corners, recordCount + count);
  }
  bool keepsCorners() const { return context->samples.size() > 1; }
  /// Interpolates what shading needs of a record at the centre of a pixel that it has won a sample of.
  void setPoint(const Record& record, int x, int y) {
    const std::int32_t px = (left + x) * kSubpixels + kOneSample[0].x,
                       py = (top + y) * kSubpixels + kOneSample[0].y;
    const std::size_t o = offset(0, x, y);
    for (int i = 0; i < 3; ++i) normal[i][o] = record.value(i, px, py);
    if (context->samples.size() > 1) centerDepth[o] = record.value(3, px, py);
  }
  /// Submission order.
  std::uint64_t orderOf(const Record& record) const;
  Surface surfaceOf(std::uint32_t batch, std::uint32_t cluster) const;
  std::size_t memoryBytes() const;
  /// Between frames: gives all threads' tiles as much memory as any of them has.
  static void levelMemory(std::vector<Tile>& tiles);

  const FrameContext* context = nullptr;
  int left = 0, top = 0;           ///< of the tile in the window, pixels
  int width = 0, height = 0;       ///< less at the window's edges
  int stride = 0;                  ///< from row to row; kernels may write whole vectors beyond the width
  std::size_t plane = 0;           ///< from sample to sample
  std::vector<float> depth;        // by offset()
  std::vector<std::uint32_t> ids;  // record that won the sample
  // At pixel centres, of the record that won a sample of the pixel last: where all samples show the same record, of
  // that one. Normal · q, and depth where no sample lies at the centre.
  std::array<std::vector<float>, 3> normal;
  std::vector<float> centerDepth;
  std::vector<Record> records;   // the first recordCount
  std::vector<Corners> corners;  // of records, in drawing order; only with several samples
  std::uint32_t recordCount = 0;
  std::vector<Attributes> attributes;
  std::vector<Surface> surfaces;            // of the tile's clusters
  const Material* plainMaterial = nullptr;  // if all have it, without textures or vertex colours
  std::vector<VertexBlock> blocks;          // of the tile's clusters
  std::span<const std::uint32_t> clusters, loose, blended, lines;
  bool overlaid = false;  // something is blended over the tile
  std::vector<glm::vec4>
      colors;  // colour · alpha, alpha, by offset(): of pixels that something is blended over
  std::vector<std::uint8_t> isBlended;  // per pixel of the tile: its colours are in `colors`
  struct {
    std::int32_t low, high;
  } sampleRange{};  ///< least and largest coordinate of the samples within a pixel
  Statistics statistics;
  StageClock clock;  // runs while the tile is drawn; stages lap their parts of `statistics`

 private:
  // To at least `count` elements, and to all that there is room for.
  template <class T>
  static void grow(std::vector<T>& vector, std::size_t count) {
    if (vector.size() >= count) return;
    if (vector.capacity() < count) vector.reserve(2 * count);
    vector.resize(vector.capacity());
  }
};

/// Planes of texture coordinates, colours and tangents of a record; made when first asked for.
const Attributes& attributesOf(Tile& tile, Record& record);

/// Rows are this much longer than tiles are wide: the longest vector.
inline constexpr int kRowPadding = 16;
/// Planes of samples are this much longer than their rows, so that a pixel's samples do not share a set of the cache.
inline constexpr std::size_t kPlanePadding = 80;

/// Depth and triangle of every sample of the tile.
void resolveVisibility(Tile& tile);
/// Blended triangles over what is visible, far to near.
void blendTriangles(Tile& tile);
/// Lines over all triangles.
void drawLines(Tile& tile);
/// The picture.
void shadeTile(Tile& tile);
/// The target's other planes, where it has them.
void writePlanes(Tile& tile);

}  // namespace limn::raster
