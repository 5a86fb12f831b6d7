#include "tests/raster/oracle_exact.h"

#include <algorithm>

namespace limn::test {
namespace {

__extension__ using Wide = __int128;  // |coordinates| < 2^62 would do; tests use less than 2^40

// Sign of the determinant that is positive when `sample` moved by (e, e²) lies to the left of a -> b on the
// screen: the first of its coefficients in 1, e and e² that is not zero decides.
int sideOf(GridPoint a, GridPoint b, GridPoint sample) {
  const Wide dx = Wide{b.x} - a.x;
  const Wide dy = Wide{b.y} - a.y;
  for (const Wide coefficient : {dy * (sample.x - a.x) - dx * (sample.y - a.y), dy, -dx}) {
    if (coefficient != 0) return coefficient > 0 ? 1 : -1;
  }
  return 0;  // a == b
}

struct PixelRange {
  std::int64_t begin, end;
};

// Pixels that a triangle with corner coordinates `a`, `b`, `c` can reach along one axis of `size` pixels.
PixelRange pixelsBetween(std::int64_t a, std::int64_t b, std::int64_t c, int size) {
  const std::int64_t lowest = std::min({a, b, c}) >> raster::kSubpixelBits;
  const std::int64_t highest = std::max({a, b, c}) >> raster::kSubpixelBits;
  return {std::clamp<std::int64_t>(lowest, 0, size), std::clamp<std::int64_t>(highest + 1, 0, size)};
}

}  // namespace

bool covers(const GridTriangle& triangle, GridPoint sample) {
  // A triangle without area, or one that faces away, has no point to the left of all its edges.
  const auto& [a, b, c] = triangle.corners;
  return sideOf(a, b, sample) > 0 && sideOf(b, c, sample) > 0 && sideOf(c, a, sample) > 0;
}

ExactImage rasterizeExactly(std::span<const GridTriangle> triangles, int width, int height,
                            std::span<const raster::SamplePosition> pattern) {
  const std::size_t samples = pattern.size();
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  std::vector<std::uint32_t> owners(pixels * samples, kNoTriangle);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const GridTriangle& triangle = triangles[t];
    const auto& [a, b, c] = triangle.corners;
    const PixelRange columns = pixelsBetween(a.x, b.x, c.x, width);
    const PixelRange rows = pixelsBetween(a.y, b.y, c.y, height);
    for (std::int64_t y = rows.begin; y < rows.end; ++y) {
      for (std::int64_t x = columns.begin; x < columns.end; ++x) {
        for (std::size_t s = 0; s < samples; ++s) {
          const GridPoint sample{x * raster::kSubpixels + pattern[s].x,
                                 y * raster::kSubpixels + pattern[s].y};
          std::uint32_t& owner = owners[(y * width + x) * samples + s];
          const bool inFront = owner == kNoTriangle || triangle.depth < triangles[owner].depth;
          if (inFront && covers(triangle, sample)) owner = t;
        }
      }
    }
  }
  ExactImage image{width, height, std::vector<int>(pixels, 0),
                   std::vector<std::uint32_t>(pixels, kNoTriangle)};
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (std::size_t s = 0; s < samples; ++s) {
      const std::uint32_t owner = owners[pixel * samples + s];
      if (owner == kNoTriangle) continue;
      image.coveredSamples[pixel]++;
      std::uint32_t& nearest = image.nearest[pixel];
      if (nearest == kNoTriangle || triangles[owner].depth < triangles[nearest].depth) nearest = owner;
    }
  }
  return image;
}

}  // namespace limn::test
