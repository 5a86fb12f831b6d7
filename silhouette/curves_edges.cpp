// The edges of a refinement by silhouette curves: those that have vertices of their own in the view, where these come to
// lie in the stream, and which triangles they replace.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III. Differs in: what
// edge_search.h and crossed_edges.h say.
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "silhouette/curves_pass.h"
#include "silhouette/step_counter.h"

namespace limn::silhouette {
namespace {

using glm::vec3;

constexpr std::size_t kItemsPerBlock = 4096;

}  // namespace

// Puts fill(item)'s results into `out`, in order: count(item) of them.
template <class T, class Count, class Fill>
void CurvesPass::collect(std::size_t items, std::vector<T>& out, const Count& count, const Fill& fill) {
  std::vector<std::uint32_t>& starts = scratch.blockCounts;
  starts.assign((items + kItemsPerBlock - 1) / kItemsPerBlock + 1, 0);
  crew.forBlocks(items, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t sum = 0;
    for (std::size_t item = begin; item < end; ++item) sum += count(item);
    starts[begin / kItemsPerBlock + 1] = sum;
  });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  out.resize(starts.back());
  crew.forBlocks(items, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t at = starts[begin / kItemsPerBlock];
    for (std::size_t item = begin; item < end; ++item)
      if (const std::uint32_t wanted = count(item); wanted > 0) {
        fill(item, at);
        at += wanted;
      }
  });
}

// Lists the edges that have vertices of their own and marks their triangles.
void CurvesPass::findEdges() {
  const auto wanted = [&](std::size_t e) -> std::uint32_t { return scratch.search.isListed(e) ? 1 : 0; };
  collect(prepared.links.size(), scratch.edges, wanted, [&](std::size_t e, std::uint32_t at) {
    scratch.edges[at] = crossedEdge(static_cast<std::uint32_t>(e));
  });
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
        if (face.triangle != kNone) markTriangle(stream.replaced, face.triangle);
    }
  });
}

CrossedEdge CurvesPass::crossedEdge(std::uint32_t e) const {
  const EdgeVertices& v = prepared.vertices[e];
  CrossedEdge record;
  record.edge = e;
  record.alpha = scratch.search.alphas[e];
  record.seam = prepared.links[e].seam;
  for (std::size_t face = 0; face < 2; ++face) {
    record.crosses[face] = scratch.search.visible[v[face][0]] != scratch.search.visible[v[face][1]];
    if (!record.crosses[face]) continue;
    record.parameter[face] = scratch.search.crossings[e][face];
    record.points[face] = face == 0 || record.seam ? silhouettePoint(record, face) : record.points[0];
  }
  return record;
}

// The unit normal is the linear one of the face, or its triangle's where the ends' normals cancel.
SegmentEnd CurvesPass::silhouettePoint(const CrossedEdge& record, std::size_t face) const {
  const float t = record.parameter[face];
  const std::array<std::uint32_t, 2>& v = prepared.vertices[record.edge][face];
  const vec3 normal = (1.0f - t) * mesh.normals[v[0]] + t * mesh.normals[v[1]];
  const float size2 = glm::dot(normal, normal);
  const vec3 unit = size2 > 1e-12f ? normal / std::sqrt(size2)
                                   : prepared.faceNormals[topology.edges()[record.edge].faces[face].triangle];
  const std::array<float, 2>& trust = prepared.trust[record.edge];
  return {bridgeOf(record).point(t), unit, (1.0f - t) * trust[0] + t * trust[1]};
}

void CurvesPass::reportCapped(std::size_t count) {
  if (count > 0) std::atomic_ref<std::size_t>(report.cappedEdges).fetch_add(count, std::memory_order_relaxed);
}

void CurvesPass::listReplaced(std::vector<std::uint32_t>& triangles) {
  const std::vector<std::uint64_t>& words = stream.replaced;
  collect(
      words.size(), triangles,
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
      settle(scratch.edges[k], curveOf(scratch.edges[k]), bridgeOf(scratch.edges[k]), open, bound, snap);
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
  const EdgeCurve curve = curveOf(record);
  EdgeVertexList list;
  const std::size_t count = listVertices(record, list);
  for (std::uint32_t k = 0; k < count; ++k) {
    const vec3 position = list[k].sample == 0 ? bridgeOf(record).point(list[k].t)
                                              : curve.sample(list[k].sample, record.segments);
    for (std::uint32_t face = 0; face < (record.seam ? 2u : 1u); ++face) {
      const Side& side = edge.faces[face];
      const float along = edge.runsBack(face) ? 1.0f - list[k].t : list[k].t;
      writer.vertex(record.firstVertex + face * record.count + k, position,
                    {side.triangle, sideWeights(side.side, along)}, kLinear);
    }
  }
}

}  // namespace limn::silhouette
