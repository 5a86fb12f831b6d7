// The first step of a refinement by blended patches: which edges bend visibly, their curves and their segments.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, (1)-(3). Differs in: edges are
// looked at by clusters (edge_clusters.h), and segment counts come from a tolerance in pixels that holds under perspective
// (pixel_bound.h).
#include <atomic>
#include <bit>
#include <numeric>

#include "silhouette/chord_kernel.h"
#include "silhouette/patches_pass.h"

namespace limn::silhouette {
namespace {

constexpr std::size_t kClustersPerBlock = 64;

}  // namespace

// Lists the edges that bend visibly, in the order of the clusters, and marks their triangles as candidates.
void PatchesPass::classify() {
  const std::size_t count = clusters.count(), blocks = (count + kClustersPerBlock - 1) / kClustersPerBlock;
  scratch.blockCounts.assign(blocks + 1, 0);
  scratch.blockCounts[0] = 1;
  scratch.masks.resize(count);
  scratch.alphas.resize(count * kEdgesPerCluster);
  scratch.scales.resize(count);
  const EdgeClusters::Eye eye = clusters.eyeOf(view, parameters);
  crew.forBlocks(count, kClustersPerBlock, [&](std::size_t begin, std::size_t end) {
    int bending = 0;
    for (std::size_t c = begin; c < end; ++c) {
      const std::span<float> alphas =
          std::span(scratch.alphas).subspan(c * kEdgesPerCluster, kEdgesPerCluster);
      scratch.masks[c] = clusters.classify(c, eye, test, alphas, scratch.scales[c]);
      bending += std::popcount(scratch.masks[c]);
    }
    scratch.blockCounts[begin / kClustersPerBlock + 1] = static_cast<std::uint32_t>(bending);
  });
  std::partial_sum(scratch.blockCounts.begin(), scratch.blockCounts.end(), scratch.blockCounts.begin());
  scratch.smooth.resize(scratch.blockCounts[blocks]);
  scratch.smooth[0] = {};
  report.smoothEdges = scratch.smooth.size() - 1;
}

// Their curves and segments.
void PatchesPass::measureEdges() {
  scratch.candidates.assign(stream.replaced.size(), 0);
  crew.forBlocks(clusters.count(), kClustersPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t record = scratch.blockCounts[begin / kClustersPerBlock];
    CurveBatch batch{};
    for (std::size_t c = begin; c < end; ++c) {
      if (scratch.masks[c] == 0) continue;
      batch.count = 0;
      describe(c, record, batch);
      setSegments(batch, record);
      record += static_cast<std::uint32_t>(batch.count);
    }
  });
}

// The records of a cluster's edges, and their curves one after the other.
void PatchesPass::describe(std::size_t cluster, std::uint32_t record, CurveBatch& batch) {
  const bool alone = crew.isAlone();
  for (std::uint64_t rest = scratch.masks[cluster]; rest != 0; rest &= rest - 1, ++record) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    const std::size_t place = cluster * kEdgesPerCluster + i;
    SmoothEdge& smooth = scratch.smooth[record];
    smooth.edge = clusters.edgeAt(place);
    smooth.alpha = scratch.alphas[place];
    smooth.inverse = 1.0f / smooth.alpha;
    smooth.scale = scratch.scales[cluster];
    smooth.seam = (clusters.seams(cluster) >> i & 1) != 0;
    const CurveOffsets& d = curves[smooth.edge];
    smooth.offsets = {smooth.alpha * d[0], smooth.alpha * d[1]};
    smooth.ends = clusters.endsAt(place);
    batch.add(mesh.positions[smooth.ends[0]], mesh.positions[smooth.ends[1]], smooth.offsets[0],
              smooth.offsets[1]);
    scratch.recordOf[smooth.edge] = record;
    const Edge& edge = topology.edges()[smooth.edge];
    smooth.firstSide = 3 * edge.faces[0].triangle + edge.faces[0].side;
    smooth.descending = edge.descending;
    for (const Side& face : edge.faces)
      if (face.triangle != kNone) markTriangle(scratch.candidates, face.triangle, alone);
  }
}

void PatchesPass::setSegments(const CurveBatch& batch, std::uint32_t record) {
  CurveErrors errors;
  if (parameters.segments == 0) curveErrors(bound, batch, errors);
  std::size_t cappedEdges = 0;
  for (std::size_t i = 0; i < batch.count; ++i) {
    bool capped = false;
    const int segments =
        parameters.segments > 0 ? parameters.segments : segmentsFor(errors[i], parameters.tolerance, capped);
    scratch.smooth[record + i].segments = static_cast<std::uint32_t>(segments);
    if (capped) ++cappedEdges;
  }
  if (cappedEdges > 0)
    std::atomic_ref<std::size_t>(report.cappedEdges).fetch_add(cappedEdges, std::memory_order_relaxed);
}

}  // namespace limn::silhouette
