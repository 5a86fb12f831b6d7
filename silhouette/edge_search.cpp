#include "silhouette/edge_search.h"

#include "silhouette/chord_kernel.h"
#include "silhouette/collect.h"
#include "silhouette/facing_kernel.h"

namespace limn::silhouette {
namespace {

constexpr std::size_t kItemsPerBlock = 4096;
constexpr float kUnseen = 0.25f;  // share of the tolerance

}  // namespace

void EdgeSearch::run(const Mesh& mesh, const Topology& topology, const CurveSet& curves, const View& view,
                     const Parameters& parameters, const Crew& crew) {
  const std::size_t edges = curves.links.size();
  heights.resize(mesh.positions.size());
  visible.resize(mesh.positions.size());
  planeHeights.resize(mesh.triangleCount());
  states.resize(edges);
  pointsOf.resize(edges);
  findVisible(curves, view, crew);

  const RingTest ring{mesh, topology, curves, view, visible, heights, points, pointsOf};
  const float largest = ring.largestProduct();
  crew.forBlocks(edges, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) states[e] = stateOf(e, curves, largest);
  });
  collect(
      crew, edges, blockCounts, candidates, [&](std::size_t e) { return states[e] != 0 ? 1U : 0U; },
      [&](std::size_t e, std::uint32_t at) { candidates[at] = static_cast<std::uint32_t>(e); });
  findPoints(mesh, curves, view, crew);
  alphas.resize(candidates.size());
  const PixelBound bound(view);
  crew.forBlocks(candidates.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    findAlphas(begin, end, ring, bound, parameters);
  });
}

void EdgeSearch::findVisible(const CurveSet& curves, const View& view, const Crew& crew) {
  const bool perspective = view.projection.perspective;
  const glm::vec3 eye = perspective ? view.eye : -view.direction;
  crew.forBlocks(heights.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    computeHeights(eye, perspective, curves.corners.arrays().from(begin), end - begin, &heights[begin]);
    for (std::size_t v = begin; v < end; ++v) visible[v] = heights[v] >= 0.0f ? 1 : 0;
  });
  crew.forBlocks(planeHeights.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    computeHeights(eye, perspective, curves.planes.arrays().from(begin), end - begin, &planeHeights[begin]);
  });
}

// Whether silhouette curves cross the edge, and whether it may show its curve.
std::uint8_t EdgeSearch::stateOf(std::size_t e, const CurveSet& curves, float largest) const {
  const EdgeLink& link = curves.links[e];
  const bool isNear = planeHeights[link.faces[0]] * planeHeights[link.faces[1]] < largest;
  bool differs = visible[link.ends[0]] != visible[link.ends[1]];
  if (link.seam) {
    const std::array<std::uint32_t, 2>& second = curves.vertices[e][1];
    differs = differs || visible[second[0]] != visible[second[1]];
  }
  const unsigned mayBend = (link.always ? 1U : 0U) | ((link.mayBend ? 1U : 0U) & (isNear ? 1U : 0U));
  const unsigned crossed = (differs ? 1U : 0U) & ((link.bridged ? 1U : 0U) | (link.always ? 1U : 0U));
  return static_cast<std::uint8_t>(crossed * kCrossed + mayBend * kMayBend);
}

void EdgeSearch::findPoints(const Mesh& mesh, const CurveSet& curves, const View& view, const Crew& crew) {
  collect(
      crew, candidates.size(), blockCounts, points,
      [&](std::size_t k) { return isCrossed(candidates[k]) ? 1U : 0U; },
      [&](std::size_t k, std::uint32_t at) {
        const std::uint32_t e = candidates[k];
        pointsOf[e] = at;
        const std::size_t faces = curves.links[e].seam ? 2 : 1;
        for (std::size_t face = 0; face < faces; ++face) {
          const std::array<std::uint32_t, 2>& v = curves.vertices[e][face];
          points[at][face] = visible[v[0]] != visible[v[1]] ? curves.silhouettePoint(mesh, view, e, face)
                                                            : SilhouettePoint{};
        }
        if (faces == 1) points[at][1] = points[at][0];
      });
}

// Of candidates begin … end - 1. Curves that nobody sees are told by batches before anything around them is looked at: on a
// fine mesh that is nearly every edge by the contour.
void EdgeSearch::findAlphas(std::size_t begin, std::size_t end, const RingTest& ring, const PixelBound& bound,
                            const Parameters& parameters) {
  CurveBatch batch{};
  std::array<std::size_t, CurveBatch::kCapacity> places;
  const auto lookAround = [&] {
    CurveErrors errors{};
    if (parameters.segments == 0) curveErrors(bound, batch, errors);
    for (std::size_t i = 0; i < batch.count; ++i) {
      float& alpha = alphas[places[i]];
      const bool isSeen = parameters.segments > 0 || errors.bends[i] > kUnseen * parameters.tolerance;
      alpha = isSeen ? ring.alpha(candidates[places[i]], alpha) : 0.0f;
    }
    batch.count = 0;
  };
  for (std::size_t k = begin; k < end; ++k) {
    const std::uint32_t e = candidates[k];
    const EdgeLink& link = ring.curves.links[e];
    alphas[k] = link.always ? 1.0f : 0.0f;
    if (link.always || (states[e] & kMayBend) == 0) continue;
    alphas[k] = ring.silhouetteness(e);
    if (alphas[k] == 0.0f) continue;
    places[batch.count] = k;
    batch.add(ring.mesh.positions[link.ends[0]], ring.mesh.positions[link.ends[1]], ring.curves.curves[e]);
    if (batch.count == CurveBatch::kCapacity) lookAround();
  }
  lookAround();
}

}  // namespace limn::silhouette
