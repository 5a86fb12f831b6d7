// The edges of a refinement by silhouette curves: those that have vertices of their own in the view, where these come to
// lie in the stream, and which triangles they replace.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III. Differs in: what
// edge_search.h and crossed_edges.h say.
#include <atomic>
#include <bit>

#include "silhouette/collect.h"
#include "silhouette/curves_pass.h"
#include "silhouette/step_counter.h"

namespace limn::silhouette {
namespace {

using glm::vec3;

constexpr std::size_t kItemsPerBlock = 4096;

}  // namespace

// Lists the edges that have vertices of their own and marks their triangles.
void CurvesPass::findEdges() {
  collect(
      crew, scratch.search.candidates.size(), scratch.blockCounts, scratch.edges,
      [&](std::size_t k) { return scratch.search.isListed(k) ? 1U : 0U; },
      [&](std::size_t k, std::uint32_t at) { scratch.edges[at] = crossedEdge(k); });
  report.smoothEdges = scratch.edges.size();
  crew.forBlocks(scratch.edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    StepCounter steps(bound, parameters);
    for (std::size_t k = begin; k < end; ++k) {
      CrossedEdge& record = scratch.edges[k];
      if (record.alpha == 0.0f) continue;
      const EdgeCurve curve = curveOf(record);
      steps.add(curve.ends[0], curve.ends[1], curve.offsets, record.segments);
    }
    reportCapped(steps.finish());
    for (std::size_t k = begin; k < end; ++k) {
      const CrossedEdge& record = scratch.edges[k];
      if (record.segments == 1 && !record.crosses[0] && !record.crosses[1]) continue;
      scratch.recordOf[record.edge] = static_cast<std::uint32_t>(k);
      for (const Side& face : topology.edges()[record.edge].faces)
        if (face.triangle != kNone) markTriangle(stream.replaced, face.triangle, crew.isAlone());
    }
  });
}

CrossedEdge CurvesPass::crossedEdge(std::size_t candidate) const {
  const EdgeSearch& search = scratch.search;
  CrossedEdge record;
  record.edge = search.candidates[candidate];
  record.alpha = search.alphas[candidate];
  record.seam = prepared.links[record.edge].seam;
  if (!search.isCrossed(record.edge)) return record;
  record.points = search.pointsOf[record.edge];
  for (std::size_t face = 0; face < 2; ++face) {
    const SilhouettePoint& point = search.points[record.points][face];
    record.crosses[face] = point.exists;
    record.parameter[face] = point.parameter;
  }
  return record;
}

void CurvesPass::reportCapped(std::size_t count) {
  if (count > 0) std::atomic_ref<std::size_t>(report.cappedEdges).fetch_add(count, std::memory_order_relaxed);
}

void CurvesPass::listReplaced(std::vector<std::uint32_t>& triangles) {
  const std::vector<std::uint64_t>& words = stream.replaced;
  collect(
      crew, words.size(), scratch.blockCounts, triangles,
      [&](std::size_t word) { return static_cast<std::uint32_t>(std::popcount(words[word])); },
      [&](std::size_t word, std::uint32_t at) {
        for (std::uint64_t rest = words[word]; rest != 0; rest &= rest - 1)
          triangles[at++] =
              static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(rest));
      });
}

// Settles where the points are, gives every edge its place in the stream and writes its vertices.
void CurvesPass::placeEdges() {
  const float snap = kSnap * parameters.tolerance;
  crew.forBlocks(scratch.edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::array<std::uint32_t, 2>& ends = prepared.vertices[scratch.edges[k].edge][0];
      const std::array<bool, 2> open{scratch.loweredOf[ends[0]] == kNone,
                                     scratch.loweredOf[ends[1]] == kNone};
      settle(scratch.edges[k], shownOf(scratch.edges[k]), open, bound, snap);
    }
  });
  StreamSize size{stream.positions.size(), 0};
  for (CrossedEdge& edge : scratch.edges) {
    edge.firstVertex = static_cast<std::uint32_t>(size.vertices);
    size.vertices += edge.vertexCount();
  }
  requireNumbered(mesh.positions.size(), size);
  stream.setCounts(size.vertices, 0);
  crew.forBlocks(scratch.edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) emitEdge(scratch.edges[k]);
  });
}

void CurvesPass::emitEdge(const CrossedEdge& record) {
  const Edge& edge = topology.edges()[record.edge];
  const ShownCurve shown = shownOf(record);
  EdgeVertexList list;
  const std::size_t count = listVertices(record, list);
  for (std::uint32_t k = 0; k < count; ++k) {
    const vec3 position =
        list[k].sample == 0 ? shown.bridge.point(list[k].t) : shown.sample(list[k].sample, record.segments);
    for (std::uint32_t face = 0; face < (record.seam ? 2u : 1u); ++face) {
      const Side& side = edge.faces[face];
      const float along = edge.runsBack(face) ? 1.0f - list[k].t : list[k].t;
      writer.vertex(record.firstVertex + face * record.count + k, position,
                    {side.triangle, sideWeights(side.side, along)}, kLinear);
    }
  }
}

}  // namespace limn::silhouette
