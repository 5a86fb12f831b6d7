#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <vector>

#include "raster/base/check.h"
#include "raster/base/workers.h"
#include "raster/batch.h"
#include "raster/effort.h"
#include "raster/front_end.h"
#include "raster/kernels.h"
#include "raster/tile.h"

namespace limn::raster {
namespace {

template <class T>
bool matches(std::span<const T> optional, std::size_t count) {
  return optional.empty() || optional.size() == count;
}

void requireValid(const Draw& draw) {
  require(draw.geometry != nullptr, "a draw needs a geometry");
  const std::size_t vertices = draw.geometry->vertexCount(), triangles = draw.geometry->triangleCount();
  require(draw.replaced.empty() || draw.replaced.size() * 64 >= triangles,
          "replaced: one bit per triangle, or none");
  require(matches(draw.posedPositions, vertices), "posedPositions: one per vertex, or none");
  require(matches(draw.posedNormals, vertices), "posedNormals: one per vertex, or none");
  require(matches(draw.posedTangents, vertices), "posedTangents: one per vertex, or none");
  const Stream& s = draw.stream;
  require(s.indices.size() == 3 * s.sourceTriangles.size(), "stream: three indices per source triangle");
  require(s.vertices.normals.size() == s.vertices.positions.size(), "stream: normals as many as positions");
  require(matches(s.vertices.texcoords, s.vertices.positions.size()),
          "stream: texcoords as many as positions");
  require(matches(s.vertices.colors, s.vertices.positions.size()), "stream: colors as many as positions");
  require(matches(s.vertices.tangents, s.vertices.positions.size()), "stream: tangents as many as positions");
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      require(std::isfinite(draw.modelToView[column][row]), "modelToView must be finite");
}

void requireValid(const Frame& frame, const Target& target) {
  const Projection& p = frame.projection;
  require(p.width >= 1 && p.width <= 16384 && p.height >= 1 && p.height <= 16384, "sizes are 1 to 16384");
  require(p.pixelsX > 0 && p.pixelsY > 0 && std::isfinite(p.pixelsX) && std::isfinite(p.pixelsY),
          "pixelsX and pixelsY must be positive");
  require(std::isfinite(p.nearPlane) && std::isfinite(p.farPlane) && p.farPlane > p.nearPlane,
          "farPlane must lie beyond nearPlane");
  require(!p.perspective || p.nearPlane > 0, "a perspective's nearPlane must be positive");
  require(frame.samples == 1 || frame.samples == 4 || frame.samples == 8, "samples are 1, 4 or 8");
  require(target.rgba != nullptr && target.rgbaStride >= 4 * static_cast<std::size_t>(p.width),
          "the target needs rgba rows of 4 bytes per pixel");
  for (const Material& m : frame.materials)
    require(m.shininess >= 1 && m.shininess <= 1024, "shininess is 1 to 1024");
  for (const Lines& lines : frame.lines) {
    require(lines.points.size() == 2 * lines.colors.size(), "lines: two points and one colour per segment");
    require(lines.width > 0.0F && lines.width <= 64.0F, "lines: a width is above 0 and at most 64");
  }
  for (const Draw& draw : frame.draws) {
    requireValid(draw);
    for (const Part& part : draw.geometry->data().parts)
      require(part.triangleCount == 0 || part.material < frame.materials.size(),
              "a part's material must be given");
  }
}

void requireValidStreams(const Frame& frame, Workers& workers) {
  constexpr std::size_t kGrain = 16384;
  for (const Draw& draw : frame.draws) {
    const std::size_t vertices = draw.geometry->vertexCount() + draw.stream.vertices.positions.size();
    const std::size_t triangles = draw.geometry->triangleCount();
    std::atomic<bool> valid = true;
    workers.forBlocks(draw.stream.sourceTriangles.size(), kGrain,
                      [&](std::size_t begin, std::size_t end, int) {
                        const auto largest = [](const std::uint32_t* first, std::size_t count) {
                          std::uint32_t most = 0;
                          for (std::size_t i = 0; i < count; ++i) most = std::max(most, first[i]);
                          return most;
                        };
                        if (largest(&draw.stream.sourceTriangles[begin], end - begin) >= triangles ||
                            largest(&draw.stream.indices[3 * begin], 3 * (end - begin)) >= vertices)
                          valid = false;
                      });
    require(valid, "stream: an index or source triangle is out of range");
  }
}

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
  s.front.run(frame, batches, s.batches.clusterCount(), map, tiling, kernels, s.workers);
  requireEffortWithinLimit(frame, batches, s.front, map, tiling, kernels, s.workers);
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
