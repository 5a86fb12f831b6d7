// What the owner of a tile works in: depth and triangle per sample, and the triangles that were seen.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/base/scratch.h"
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
inline constexpr std::size_t kGroup = 4;  ///< samples of a pixel that lie side by side
inline constexpr std::uint32_t kNoRecord = 0xffffffffU;
/// Of an empty sample. What lies beyond the far plane is cut off, so whatever covers a sample is nearer than
/// nothing, even where its depth is rounding noise. All bytes are the same, so that clearing is quick.
inline constexpr unsigned char kNoDepthByte = 0xfe;
inline constexpr float kNoDepth = std::bit_cast<float>(0xfefefefeU);

/// A triangle that won at least one sample, or a micro triangle that covers one: the planes of its normal · q and depth, and where it comes from.
struct alignas(64) Record {
  float origin[4], slopeX[4], slopeY[4];
  std::int32_t x0, y0;   ///< where the planes are anchored
  std::uint32_t source;  ///< cluster of the tile · kClusterTriangles + triangle, or kLoose + loose triangle
  std::uint32_t attributes;  ///< index into Tile::attributes, or kNoRecord: not asked for yet

  static constexpr std::uint32_t kLoose = 0x80000000U;

  /// Of the plane i at a sub-pixel of the window. Anchored at a corner, so the same in all tiles.
  float value(int i, std::int32_t x, std::int32_t y) const {
    return (origin[i] + slopeY[i] * static_cast<float>(y - y0)) + slopeX[i] * static_cast<float>(x - x0);
  }
};

/// Whether a record's triangle covers the centres of pixels: its edge functions, divided by 256, at the centre of the
/// tile's first pixel, and their steps. Modulo 2^32; at pixels that it covers a sample of they fit 32 bits. Edges that
/// the centres of all those are inside of may be 0.
struct alignas(16) CenterEdges {
  std::int32_t value[4], stepX[4], stepY[4];
};

/// The planes of a record's texture coordinates times q, and the slopes of q itself.
struct alignas(16) TexturePlanes {
  float origin[2], slopeX[2], slopeY[2];
  float slopeQ[2];      ///< along x and y; 0 in orthographic views
  std::int32_t x0, y0;  ///< as the record's
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
  /// Pixels lie in strips of columns, so that a row of a strip is what the longest vector holds and its rows follow each
  /// other. x, y from the tile's corner.
  std::size_t pixelOffset(int x, int y) const {
    const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
    return column / kStripWidth * strip + row * kStripWidth + column % kStripWidth;
  }
  /// Of several samples, four lie side by side: vectors hold those of a few pixels.
  std::size_t offset(int sample, int x, int y) const {
    if (!hasSeveralSamples()) return pixelOffset(x, y);
    const auto s = static_cast<std::size_t>(sample);
    return (s / kGroup * plane + pixelOffset(x, y)) * kGroup + s % kGroup;
  }
  /// Makes sure that the pixels [x0, x1) × [y0, y1), not none, have their samples: empty ones, where nothing was drawn.
  void touch(int x0, int y0, int x1, int y1) {
    const std::uint64_t columns = (2U << ((x1 - 1) / kCellWidth)) - (1U << (x0 / kCellWidth));
    const std::uint64_t rows = (kFirstCells << (y0 / kCellHeight * 8)) &
                               (kFirstCells >> ((kCellRows - 1 - (y1 - 1) / kCellHeight) * 8));
    if (const std::uint64_t fresh = rows * columns & ~touched_; fresh != 0) clear(fresh);
  }
  /// Whether a pixel was; the others are empty, and nobody may look at their samples.
  bool isTouched(int x, int y) const {
    return ((touched_ >> (y / kCellHeight * 8 + x / kCellWidth)) & 1U) != 0;
  }
  static constexpr int kCellWidth = 16, kCellHeight = 8;  ///< pixels are cleared that many at a time
  static constexpr std::size_t kStripWidth = kCellWidth;
  /// The samples of a pixel that show a record.
  unsigned samplesOf(std::uint32_t id, int x, int y) const {
    unsigned mask = 0;
    for (unsigned s = 0; s < context->samples.size(); ++s)
      mask |= static_cast<unsigned>(ids[offset(static_cast<int>(s), x, y)] == id) << s;
    return mask;
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
    if (hasSeveralSamples()) centerEdges[recordCount] = centerEdgesOf(drawn);
    return recordCount++;
  }
  /// Makes room for so many more.
  void reserveRecords(std::size_t count) {
    grow(records, recordCount + count);
    if (hasSeveralSamples()) grow(centerEdges, recordCount + count);
    if (texturedMaterial != nullptr) grow(texturePlanes, recordCount + count);
  }
  bool hasSeveralSamples() const { return context->samples.size() > 1; }
  CenterEdges centerEdgesOf(const Corners& drawn) const;
  /// Interpolates what shading needs of a record at the centre of a pixel that it has won a sample of.
  void setPoint(const Record& record, int x, int y) {
    const std::int32_t px = (left + x) * kSubpixels + kOneSample[0].x,
                       py = (top + y) * kSubpixels + kOneSample[0].y;
    const std::size_t o = pixelOffset(x, y);
    if (hasSeveralSamples())
      for (int i = 0; i < 4; ++i) centers[4 * o + static_cast<std::size_t>(i)] = record.value(i, px, py);
    else
      for (int i = 0; i < 3; ++i) normal[i][o] = record.value(i, px, py);
  }
  /// Submission order.
  std::uint64_t orderOf(const Record& record) const;
  Surface surfaceOf(std::uint32_t batch, std::uint32_t cluster) const;
  std::size_t memoryBytes() const;
  /// Between frames: gives all threads' tiles as much memory as any of them has.
  static void levelMemory(std::vector<Tile>& tiles);

  const FrameContext* context = nullptr;
  int left = 0, top = 0;             ///< of the tile in the window, pixels
  int width = 0, height = 0;         ///< less at the window's edges
  std::size_t strip = 0;             ///< pixels from strip to strip, padding included
  std::size_t plane = 0;             ///< pixels with those of the padding
  AlignedVector<float> depth;        // by offset()
  AlignedVector<std::uint32_t> ids;  // record that won the sample
  // At pixel centres, of the record that won the pixel last: normal · q. With several samples, none of which lies there,
  // normal · q and depth side by side, of the record that all samples show; where they do not, of nothing.
  std::array<std::vector<float>, 3> normal;
  AlignedVector<float> centers;
  std::vector<Record> records;           // the first recordCount
  std::vector<CenterEdges> centerEdges;  // of records; only with several samples
  std::uint32_t recordCount = 0;
  std::vector<Attributes> attributes;
  std::vector<Surface> surfaces;            // of the tile's clusters
  const Material* plainMaterial = nullptr;  // if all have it, without textures or vertex colours
  const Material* texturedMaterial =
      nullptr;  // if all have it, with no texture but of its base colour, nor vertex colours
  bool hasSoleMaterial() const { return plainMaterial != nullptr || texturedMaterial != nullptr; }
  std::vector<TexturePlanes> texturePlanes;  // of records, where there is such a material
  std::vector<VertexBlock> blocks;           // of the tile's clusters
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
  // Samples are cleared when first needed, by cells: bit column + 8 · row of `touched_`.
  static constexpr int kCellRows = 8;
  static constexpr std::uint64_t kFirstCells = 0x0101010101010101U;  // of all rows
  void clear(std::uint64_t cells);
  void setSoleMaterial();
  std::uint64_t touched_ = 0;

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
/// Texture coordinates of a cluster's vertices, times q.
void setTexcoords(const Batch& batch, const Cluster& cluster, const Material& material, bool perspective,
                  VertexBlock& block);

/// Strips are this much longer than their rows, so that what belongs to neighbours shares no set of the cache.
inline constexpr std::size_t kStripPadding = 80;

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
