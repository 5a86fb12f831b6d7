#include <bit>
#include <vector>

#include "raster/base/check.h"
#include "raster/base/workers.h"
#include "raster/batch.h"
#include "raster/effort.h"
#include "raster/front_end.h"
#include "raster/kernels.h"
#include "raster/tile.h"
#include "raster/validate.h"

namespace limn::raster {
namespace {

std::uint64_t submittedTriangles(const Frame& frame) {
  std::uint64_t count = 0;
  for (const Draw& draw : frame.draws) {
    const std::size_t triangles = draw.geometry->triangleCount();
    count += triangles + draw.stream.sourceTriangles.size();
    if (draw.replaced.empty()) continue;
    for (std::size_t word = 0; word < triangles / 64; ++word) count -= std::popcount(draw.replaced[word]);
    if (triangles % 64 != 0)
      count -= std::popcount(draw.replaced[triangles / 64] & ~(~std::uint64_t{0} << (triangles % 64)));
  }
  return count;
}

}  // namespace

struct Renderer::State {
  State(int threads, const Tuning& t)
      : workers(threads), tuning(t), tiles(static_cast<std::size_t>(threads)) {}

  Workers workers;
  Tuning tuning;
  BatchBuilder batches;
  FrontEnd front;
  LineBins lines;
  std::vector<Tile> tiles;  // one per thread
};

Renderer::Renderer(int threads, const Tuning& tuning) {
  require(tuning.tileWidth >= 16 && tuning.tileWidth <= 128 && tuning.tileWidth % 16 == 0 &&
              tuning.tileHeight >= 1 && tuning.tileHeight <= 64,
          "tiles are multiples of 16 up to 128 wide and 1 to 64 high");
  state_ = std::make_unique<State>(threads, tuning);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::draw(const Frame& frame, const Target& target, Statistics* statistics) {
  requireValid(frame, target);
  State& s = *state_;
  requireValidStreams(frame, s.workers);

  const ScreenMap map(frame.projection);
  const Tiling tiling(map.width, map.height, s.tuning.tileWidth, s.tuning.tileHeight);
  // All threads work together until tiles are drawn.
  StageClock clock = StageClock::started(statistics != nullptr);
  double transformMs = 0.0, binningMs = 0.0;
  const std::span<const Batch> batches = s.batches.build(frame, map, s.workers);
  clock.lap(transformMs);
  const Kernels kernels = s.tuning.scalar ? scalarKernels() : vectorKernels();
  s.front.cull(frame, batches, s.batches.clusterCount(), map, tiling, kernels, s.workers);
  requireEffortWithinLimit(frame, batches, s.front, map, tiling, kernels, s.workers);
  s.front.bin(tiling, s.workers);
  s.lines.run(frame, map, tiling, s.workers);
  clock.lap(binningMs);

  const FrameContext context{frame,
                             target,
                             map,
                             tiling,
                             batches,
                             s.front,
                             samplePattern(frame.samples),
                             kernels,
                             s.lines,
                             statistics != nullptr};
  for (Tile& tile : s.tiles) tile.statistics = {};
  s.workers.forBlocks(tiling.count(), 1, [&](std::size_t index, std::size_t, int slot) {
    Tile& tile = s.tiles[static_cast<std::size_t>(slot)];
    tile.begin(context, index);
    kernels.resolveVisibility(tile);
    tile.clock.lap(tile.statistics.visibilityMs);
    blendTriangles(tile);
    drawLines(tile);
    kernels.shadeTile(tile);
    writePlanes(tile);
    tile.clock.lap(tile.statistics.shadingMs);
  });
  Tile::levelMemory(s.tiles);

  if (statistics == nullptr) return;
  *statistics = {};
  statistics->transformMs = s.workers.threads() * transformMs;
  statistics->binningMs = s.workers.threads() * binningMs;
  statistics->trianglesIn = submittedTriangles(frame);
  statistics->scratchBytes = s.batches.memoryBytes() + s.front.memoryBytes() + s.lines.memoryBytes();
  for (const Tile& tile : s.tiles) {
    statistics->trianglesDrawn += tile.statistics.trianglesDrawn;
    statistics->pixelsShaded += tile.statistics.pixelsShaded;
    statistics->pixelsCovered += tile.statistics.pixelsCovered;
    statistics->transformMs += tile.statistics.transformMs;
    statistics->setupMs += tile.statistics.setupMs;
    statistics->visibilityMs += tile.statistics.visibilityMs;
    statistics->shadingMs += tile.statistics.shadingMs;
    statistics->resolveMs += tile.statistics.resolveMs;
    statistics->scratchBytes += tile.memoryBytes();
  }
}

}  // namespace limn::raster
