// Blended triangles: source over, per sample, in linear light.
//
// Based on: T. Porter, T. Duff, "Compositing digital images", 1984.
// Differs in: nothing; pixels that nothing is blended over never get colours per sample.
#include "raster/blend.h"

#include "raster/setup.h"
#include "raster/surface.h"
#include "raster/tile.h"

namespace limn::raster {
namespace {

void blendPixel(Tile& tile, TriangleSetup& t, int x, int y) {
  const unsigned coverage = t.coverage(tile, x, y);
  unsigned seen = 0;
  for (unsigned s = 0; coverage >> s != 0; ++s) {
    const bool covered = ((coverage >> s) & 1U) != 0;
    seen |= static_cast<unsigned>(covered && t.depthAt(tile, s, x, y) >=
                                                 tile.depth[tile.offset(static_cast<int>(s), x, y)])
            << s;
  }
  if (seen == 0) return;
  const glm::vec4 color = shadeAt(tile, t.record, shadingPoint(tile, t.corners, coverage, x, y));
  if (color.w <= 0.0F) return;
  openPixel(tile, x, y);
  for (unsigned s = 0; seen >> s != 0; ++s)
    if (((seen >> s) & 1U) != 0) blendOver(tile.colors[tile.offset(static_cast<int>(s), x, y)], color);
}

}  // namespace

void openPixel(Tile& tile, int x, int y) {
  std::uint8_t& isBlended = tile.isBlended[tile.pixelOffset(x, y)];
  if (isBlended != 0) return;
  isBlended = 1;
  const glm::vec4 b = tile.context->frame.background;
  const auto samples = static_cast<int>(tile.context->samples.size());
  unsigned left = (1U << samples) - 1U;
  for (int s = 0; s < samples; ++s) {
    if (((left >> s) & 1U) == 0) continue;
    const std::uint32_t id = tile.ids[tile.offset(s, x, y)];
    const unsigned mask = tile.samplesOf(id, x, y);
    left &= ~mask;
    glm::vec4 color{b.x * b.w, b.y * b.w, b.z * b.w, b.w};
    if (id != kNoRecord) {
      Record& record = tile.records[id];
      color = shadeAt(tile, record, shadingPoint(tile, tile.cornersOf(record), mask, x, y));
    }
    for (int k = s; k < samples; ++k)
      if (((mask >> k) & 1U) != 0) tile.colors[tile.offset(k, x, y)] = color;
  }
}

void blendTriangles(Tile& tile) {
  TriangleSetup t;
  for (const std::uint32_t item : tile.blended) {
    if (!setLoose(tile, item, t)) continue;
    ++tile.statistics.trianglesDrawn;
    for (int y = t.pixels.y0; y < t.pixels.y1; ++y)
      for (int x = t.pixels.x0; x < t.pixels.x1; ++x) blendPixel(tile, t, x, y);
  }
}

}  // namespace limn::raster
