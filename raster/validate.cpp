#include "raster/validate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "raster/base/check.h"
#include "raster/cluster.h"
#include "raster/numbers.h"

namespace limn::raster {
namespace {

template <class T>
bool matches(std::span<const T> optional, std::size_t count) {
  return optional.empty() || optional.size() == count;
}

void requireAligned(const Vertices& v) {
  const std::size_t vertices = v.positions.size();
  require(v.normals.size() == vertices, "normals must be as many as positions");
  require(matches(v.texcoords, vertices), "texcoords must be as many as positions, or none");
  require(matches(v.colors, vertices), "colors must be as many as positions, or none");
  require(matches(v.tangents, vertices), "tangents must be as many as positions, or none");
}

void requireFinite(const glm::mat4& modelToView) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      require(std::isfinite(modelToView[column][row]), "modelToView must be finite");
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
  requireAligned(s.vertices);
  requireFinite(draw.modelToView);
}

// Within these bounds coordinates in the window, and what they are computed from, are finite.
void requireValid(const Projection& p) {
  constexpr float kLeast = 1e-33F, kMost = 1e36F;
  require(p.width >= 1 && p.width <= 16384 && p.height >= 1 && p.height <= 16384, "sizes are 1 to 16384");
  require(p.pixelsX >= kLeast && p.pixelsX <= kMost && p.pixelsY >= kLeast && p.pixelsY <= kMost,
          "pixelsX and pixelsY must be positive, 1e-33 to 1e36");
  require(std::isfinite(p.nearPlane) && std::isfinite(p.farPlane) && p.farPlane > p.nearPlane,
          "farPlane must lie beyond nearPlane");
  require(!p.perspective || p.nearPlane >= std::numeric_limits<float>::min(),
          "a perspective's nearPlane must be positive, and no denormal number");
}

void requireValid(const Target& target, std::size_t width) {
  require(target.rgba != nullptr && target.rgbaStride >= 4 * width,
          "the target needs rgba rows of 4 bytes per pixel");
  const auto holdsRows = [width](const void* plane, std::size_t stride) {
    return plane == nullptr || stride >= width;
  };
  require(holdsRows(target.depth, target.depthStride), "depthStride must be at least the width");
  require(holdsRows(target.normals, target.normalStride), "normalStride must be at least the width");
  require(holdsRows(target.ids, target.idStride), "idStride must be at least the width");
}

}  // namespace

void requireValid(const Vertices& v, std::span<const std::uint32_t> indices, std::span<const Part> parts) {
  const std::size_t vertices = v.positions.size();
  requireAligned(v);
  require(indices.size() % 3 == 0, "indices must be three per triangle");
  require(vertices < 0x7fffffffU && indices.size() / 3 < 0x7fffffffU,
          "at most 2^31 - 1 vertices and triangles");
  for (const std::uint32_t i : indices) require(i < vertices, "index beyond the vertices");
  for (const glm::vec3& p : v.positions) require(isFinite(p), "positions must be finite");
  std::size_t next = 0;
  for (const Part& part : parts) {
    require(part.firstTriangle == next, "parts must tile the triangles in order");
    next += part.triangleCount;
  }
  require(next == indices.size() / 3, "parts must cover all triangles");
}

void requireValid(const Frame& frame, const Target& target) {
  requireValid(frame.projection);
  require(frame.samples == 1 || frame.samples == 4 || frame.samples == 8, "samples are 1, 4 or 8");
  requireValid(target, static_cast<std::size_t>(frame.projection.width));
  for (const Material& m : frame.materials)
    require(m.shininess >= 1 && m.shininess <= 1024, "shininess is 1 to 1024");
  for (const Lines& lines : frame.lines) {
    require(lines.points.size() == 2 * lines.colors.size(), "lines: two points and one colour per segment");
    require(lines.width > 0.0F && lines.width <= 64.0F, "lines: a width is above 0 and at most 64");
    requireFinite(lines.modelToView);
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
    const std::span<const std::uint32_t> sources = draw.stream.sourceTriangles;
    const std::uint32_t* const indices = draw.stream.indices.data();
    std::atomic<bool> known = true, ordered = true;
    workers.forBlocks(sources.size(), kGrain, [&](std::size_t begin, std::size_t end, int) {
      std::uint32_t lastSource = 0, lastIndex = 0, descents = 0;
      for (std::size_t i = begin; i < end; ++i) lastSource = std::max(lastSource, sources[i]);
      for (std::size_t i = 3 * begin; i < 3 * end; ++i) lastIndex = std::max(lastIndex, indices[i]);
      for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i)
        descents += sources[i] < sources[i - 1] ? 1 : 0;
      if (lastSource >= triangles || lastIndex >= vertices) known = false;
      if (descents != 0) ordered = false;
    });
    require(known, "stream: an index or source triangle is out of range");
    require(ordered, "stream: its triangles must be ordered by source triangle");
  }
}

}  // namespace limn::raster
