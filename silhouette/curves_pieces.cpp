// The pieces of a refinement by silhouette curves: what each replaced triangle is cut into along its sides' vertices and
// its segment, and the list of the contour's lines.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III. Differs in: what remesh.h
// says.
#include <algorithm>

#include "raster/base/check.h"
#include "silhouette/curves_pass.h"
#include "silhouette/patch.h"

namespace limn::silhouette {
namespace {

constexpr std::size_t kTrianglesPerBlock = 256;

}  // namespace

void CurvesPass::placePieces() {
  const std::vector<std::uint32_t>& triangles = scratch.triangles;
  scratch.slots.resize(triangles.size() + 1);
  StreamSize size{stream.positions.size(), 0};
  scratch.slots[0] = {static_cast<std::uint32_t>(size.vertices), 0};
  crew.forBlocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) scratch.slots[k + 1] = sizeOf(triangles[k]);
  });
  for (Slot& slot : std::span(scratch.slots).subspan(1)) {
    size.vertices += slot.vertex;
    size.triangles += slot.triangle;
    slot = {static_cast<std::uint32_t>(size.vertices), static_cast<std::uint32_t>(size.triangles)};
  }
  requireNumbered(mesh.positions.size(), size);
  stream.setCounts(size.vertices, size.triangles);
  report.curvedTriangles = triangles.size();
  crew.forBlocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) emitPieces(k);
  });
}

// Vertices and triangles that a triangle adds to the stream.
CurvesPass::Slot CurvesPass::sizeOf(std::uint32_t triangle) const {
  const SideViews sides = sidesOf(triangle);
  const auto onSides = static_cast<std::uint32_t>(sides[0].count() + sides[1].count() + sides[2].count());
  Cut cut;
  if (cutOf(triangle, sides, cut)) {
    const std::uint32_t samples = scratch.segments[scratch.segmentOf[triangle]].steps - 1;
    return {samples, 1 + onSides + 2 * samples};
  }
  return wantsCentre({sides[0].count(), sides[1].count(), sides[2].count()}) ? Slot{1, 3 + onSides}
                                                                             : Slot{0, 1 + onSides};
}

// Whether the triangle has a segment, and where it ends on the sides.
bool CurvesPass::cutOf(std::uint32_t triangle, const SideViews& sides, Cut& cut) const {
  const std::uint32_t index = scratch.segmentOf[triangle];
  if (index == kNone || !scratch.segments[index].exists) return false;
  const std::size_t lone = scratch.segments[index].lone, back = (lone + 2) % 3;
  cut.lone = lone;
  cut.ends = {sides[lone].rank(), sides[back].rank()};
  return cut.ends[0] != 0 || cut.ends[1] != sides[back].count() + 1;
}

void CurvesPass::setOutline(std::uint32_t triangle, const SideViews& sides, Outline& outline) const {
  for (std::size_t k = 0; k < 3; ++k) {
    outline.corners[k] = drawnVertex(mesh.indices[3 * std::size_t{triangle} + k]);
    outline.counts[k] = sides[k].count();
    for (std::size_t i = 0; i < outline.counts[k]; ++i) outline.sides[k][i] = firstNew() + sides[k].vertex(i);
  }
}

void CurvesPass::emitPieces(std::size_t k) {
  const std::uint32_t triangle = scratch.triangles[k];
  const Slot& slot = scratch.slots[k];
  const SideViews sides = sidesOf(triangle);
  Outline outline;
  setOutline(triangle, sides, outline);
  Pieces pieces;
  Cut cut;
  if (cutOf(triangle, sides, cut)) {
    const Segment& segment = scratch.segments[scratch.segmentOf[triangle]];
    std::array<std::uint32_t, kMaxSegments> samples;
    for (std::uint32_t i = 1; i < segment.steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(segment.steps);
      const std::uint32_t at = slot.vertex + i - 1;
      samples[i - 1] = firstNew() + at;
      writer.vertex(at,
                    polylineVertex(segment.ends[0].place, segment.ends[1].place, segment.offsets,
                                   static_cast<int>(i), static_cast<int>(segment.steps)),
                    {triangle, (1.0f - t) * segment.weights[0] + t * segment.weights[1]}, kLinear);
    }
    cut.samples = std::span(samples).first(segment.steps - 1);
    remesh(outline, cut, bound, {mesh.positions, stream.positions}, pieces);
  } else {
    if (wantsCentre(outline.counts)) {
      outline.centre = firstNew() + slot.vertex;
      writeCentre(slot.vertex, triangle, sides);
    }
    remesh(outline, pieces);
  }
  LIMN_ASSERT(slot.triangle + pieces.count == scratch.slots[k + 1].triangle, triangle, pieces.count);
  for (std::size_t i = 0; i < pieces.count; ++i) {
    const std::size_t at = slot.triangle + i;
    std::copy(pieces.triangles[i].begin(), pieces.triangles[i].end(),
              stream.indices.begin() + static_cast<std::ptrdiff_t>(3 * at));
    stream.sourceTriangles[at] = triangle;
  }
}

// The middle of the patch that the curves of the sides make.
void CurvesPass::writeCentre(std::uint32_t at, std::uint32_t triangle, const SideViews& sides) {
  constexpr float third = 1.0f / 3.0f;
  Patch patch;
  for (std::size_t k = 0; k < 3; ++k) {
    patch.corners[k] = mesh.positions[mesh.indices[3 * std::size_t{triangle} + k]];
    const SideView& side = sides[k];
    if (side.edge == nullptr || side.edge->segments == 1) continue;
    const CurveOffsets offsets = curveOf(*side.edge).offsets;
    patch.sides[k] = {offsets[side.back ? 1 : 0], offsets[side.back ? 0 : 1]};
    if (!prepared.centers.empty())
      patch.fittedCenter += (third * side.edge->alpha) * prepared.centers[triangle];
  }
  writer.vertex(at, patch.point(third, third, third), {triangle, {third, third}}, kLinear);
}

// Bridges in the order of their edges, then segments in that of their triangles.
void CurvesPass::listContour() {
  std::uint32_t last = 0;
  const auto lineTo = [&](std::uint32_t vertex, bool crossesTriangle) {
    if (vertex != last) stream.contour.push_back({last, vertex, crossesTriangle});
    last = vertex;
  };
  for (const CrossedEdge& edge : scratch.edges) {
    if (!edge.crosses[0] && !edge.crosses[1]) continue;
    const std::array<std::uint32_t, 2>& ends = prepared.vertices[edge.edge][0];
    last = drawnVertex(ends[0]);
    for (std::uint32_t k = 0; k < edge.count; ++k) lineTo(firstNew() + edge.firstVertex + k, false);
    lineTo(drawnVertex(ends[1]), false);
  }
  for (std::size_t k = 0; k < scratch.triangles.size(); ++k) {
    const SideViews sides = sidesOf(scratch.triangles[k]);
    Cut cut;
    if (!cutOf(scratch.triangles[k], sides, cut)) continue;
    Outline outline;
    setOutline(scratch.triangles[k], sides, outline);
    last = outline.onSide(cut.lone, cut.ends[0]);
    for (std::uint32_t v = scratch.slots[k].vertex; v < scratch.slots[k + 1].vertex; ++v)
      lineTo(firstNew() + v, true);
    lineTo(outline.onSide((cut.lone + 2) % 3, cut.ends[1]), true);
  }
}

}  // namespace limn::silhouette
