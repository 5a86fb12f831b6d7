// The last step of a refinement by blended patches: vertices along the bending edges, once for both of their triangles,
// and vertices and triangles inside.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004. Differs in: what patch.h says.
#include <bit>
#include <span>

#include "silhouette/patch.h"
#include "silhouette/patches_pass.h"

namespace limn::silhouette {
namespace {

using glm::vec3;

constexpr std::size_t kEdgesPerBlock = 4096;

}  // namespace

void PatchesPass::emit() {
  const std::span<const SmoothEdge> bending = std::span(scratch.smooth).subspan(1);
  crew.forBlocks(bending.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (const SmoothEdge& smooth : bending.subspan(begin, end - begin)) emitEdge(smooth);
  });
  crew.forBlocks(stream.replaced.size(), kWordsPerBlock, [&](std::size_t begin, std::size_t end) {
    const StreamSize& before = scratch.shares[begin / kWordsPerBlock].size;
    auto vertex = static_cast<std::uint32_t>(before.vertices);
    auto face = static_cast<std::uint32_t>(before.triangles);
    for (std::size_t word = begin; word < end; ++word) {
      std::uint32_t next = scratch.firstCut[word];
      for (std::uint64_t rest = scratch.candidates[word]; rest != 0; rest &= rest - 1, ++next)
        if ((stream.replaced[word] & rest & (~rest + 1)) != 0)
          emitTriangle(
              static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(rest)),
              scratch.cuts[next], vertex, face);
    }
  });
}

void PatchesPass::emitEdge(const SmoothEdge& smooth) {
  const Edge& edge = topology.edges()[smooth.edge];
  const vec3 &p = mesh.positions[smooth.ends[0]], &q = mesh.positions[smooth.ends[1]];
  for (std::uint32_t k = 1; k < smooth.segments; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(smooth.segments);
    const vec3 position = curvePoint(p, q, smooth.offsets, t);
    const std::uint32_t at = smooth.firstVertex + k - 1;
    for (std::uint32_t face = 0; face < (smooth.seam ? 2u : 1u); ++face) {
      const Side& side = edge.faces[face];
      const float along = edge.runsBack(face) ? 1.0f - t : t;
      std::array<float, 3> alphas{};
      alphas[side.side] = smooth.alpha;
      writer.vertex(at + face * smooth.inner(), position, {side.triangle, sideWeights(side.side, along)},
                    alphas);
    }
  }
}

SidePoints PatchesPass::sidePointsOf(std::uint32_t side, const SmoothEdge& smooth) const {
  const std::uint32_t before = smooth.seam && smooth.isSecond(side) ? smooth.inner() : 0;
  return {mesh.indices[side], mesh.indices[nextInTriangle(side)],
          static_cast<std::uint32_t>(mesh.positions.size()) + smooth.firstVertex + before, smooth.segments,
          smooth.runsBack(side)};
}

// From the list: with few segments, which loop runs how often cannot be predicted.
void PatchesPass::emitBare(std::uint32_t triangle, const Records& records, const Pattern& pattern,
                           std::uint32_t& face) {
  std::array<std::uint32_t, 3 * BareTriangles::kMaxSegments> points;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const SidePoints side = sidePointsOf(3 * triangle + k, *records[k]);
    const std::uint32_t first = side.backwards ? side.first + side.segments - 2 : side.first;
    const std::uint32_t step = side.backwards ? ~0u : 1u;  // -1, modulo 2^32
    points[4 * k] = side.from;
    for (std::uint32_t i = 0; i < 3; ++i) points[4 * k + 1 + i] = first + i * step;  // more than there are
  }
  const BareTriangles& list = BareTriangles::of(pattern);
  for (std::uint32_t i = 0; i < list.count; ++i) {
    const std::array<std::uint8_t, 3>& corner = list.corners[i];
    writer.triangle(face++, triangle, points[corner[0]], points[corner[1]], points[corner[2]]);
  }
}

Patch PatchesPass::patchOf(std::size_t triangle, const Records& records) const {
  Patch patch;
  patch.wholeFromContour = parameters.silhouetteness == Silhouetteness::kCrossing;
  const auto side = static_cast<std::uint32_t>(3 * triangle);
  for (std::uint32_t k = 0; k < 3; ++k) {
    patch.corners[k] = mesh.positions[mesh.indices[side + k]];
    patch.alphas[k] = records[k]->alpha;
    if (!records[k]->bends()) continue;
    const bool back = records[k]->runsBack(side + k);
    const CurveOffsets& d = curves[records[k]->edge];
    patch.sides[k] = {d[back ? 1 : 0], d[back ? 0 : 1]};
  }
  if (!centers.empty()) patch.fittedCenter = centers[triangle];
  return patch;
}

void PatchesPass::emitTriangle(std::uint32_t triangle, const Pattern& pattern, std::uint32_t& vertex,
                               std::uint32_t& face) {
  const Records records = recordsOf(triangle);
  if (BareTriangles::has(pattern)) return emitBare(triangle, records, pattern, face);
  const std::uint32_t firstInner = static_cast<std::uint32_t>(mesh.positions.size()) + vertex;
  if (pattern.vertexCount() > 0) {
    const Patch patch = patchOf(triangle, records);
    forVertices(pattern, [&](float v, float w) {
      writer.vertex(vertex++, patch.point(1.0f - v - w, v, w), {triangle, {v, w}}, patch.alphas);
    });
  }
  const std::array<SidePoints, 3> sides{sidePointsOf(3 * triangle, *records[0]),
                                        sidePointsOf(3 * triangle + 1, *records[1]),
                                        sidePointsOf(3 * triangle + 2, *records[2])};
  forTriangles(
      pattern, [&](std::uint32_t k, std::uint32_t i) { return sides[k](i); },
      [&](std::uint32_t i) { return firstInner + i; },
      [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { writer.triangle(face++, triangle, a, b, c); });
}

}  // namespace limn::silhouette
