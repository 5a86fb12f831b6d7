#include "silhouette/edge_search.h"

#include "silhouette/chord_kernel.h"
#include "silhouette/contour.h"
#include "silhouette/facing_kernel.h"
#include "silhouette/pixel_bound.h"

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
  crossings.resize(edges);
  alphas.resize(edges);
  findVisible(curves, view, crew);

  const RingTest ring{mesh, topology, curves, view, visible, heights, crossings};
  const float largest = ring.largestProduct();
  const PixelBound bound(view);
  crew.forBlocks(edges, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) states[e] = stateOf(e, mesh, curves, view, largest);
  });
  crew.forBlocks(edges, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    findAlphas(begin, end, ring, bound, parameters);
    for (std::size_t e = begin; e < end; ++e)
      if (states[e] != 0 && (alphas[e] > 0.0f || ((states[e] & kCrossed) != 0 && curves.links[e].bridged)))
        states[e] |= kListed;
  });
}

// Of the edges begin … end - 1 that matter. Curves that nobody sees are told by batches before anything around them is
// looked at: on a fine mesh that is nearly every edge by the contour.
void EdgeSearch::findAlphas(std::size_t begin, std::size_t end, const RingTest& ring, const PixelBound& bound,
                            const Parameters& parameters) {
  CurveBatch batch{};
  std::array<std::uint32_t, CurveBatch::kCapacity> edges;
  const auto lookAround = [&] {
    CurveErrors errors;
    if (parameters.segments == 0) curveErrors(bound, batch, errors);
    for (std::size_t i = 0; i < batch.count; ++i) {
      const bool isSeen = parameters.segments > 0 || errors.bends[i] > kUnseen * parameters.tolerance;
      alphas[edges[i]] = isSeen ? ring.alpha(edges[i], alphas[edges[i]]) : 0.0f;
    }
    batch.count = 0;
  };
  for (std::size_t e = begin; e < end; ++e) {
    if (states[e] == 0) continue;
    const EdgeLink& link = ring.curves.links[e];
    alphas[e] = link.always ? 1.0f : 0.0f;
    if (link.always || (states[e] & kMayBend) == 0) continue;
    alphas[e] = ring.silhouetteness(static_cast<std::uint32_t>(e));
    if (alphas[e] == 0.0f) continue;
    edges[batch.count] = static_cast<std::uint32_t>(e);
    batch.add(ring.mesh.positions[link.ends[0]], ring.mesh.positions[link.ends[1]], ring.curves.curves[e]);
    if (batch.count == CurveBatch::kCapacity) lookAround();
  }
  lookAround();
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

// Whether silhouette curves cross the edge, and where, and whether it may show its curve.
std::uint8_t EdgeSearch::stateOf(std::size_t e, const Mesh& mesh, const CurveSet& curves, const View& view,
                                 float largest) {
  const EdgeLink& link = curves.links[e];
  const bool mayBend =
      link.always || (link.mayBend && planeHeights[link.faces[0]] * planeHeights[link.faces[1]] < largest);
  std::uint8_t state = mayBend ? kMayBend : 0;
  if (!link.seam && visible[link.ends[0]] == visible[link.ends[1]]) return state;
  for (std::size_t face = 0; face < (link.seam ? 2u : 1u); ++face) {
    const std::array<std::uint32_t, 2>& v = curves.vertices[e][face];
    if (visible[v[0]] == visible[v[1]]) continue;
    state |= kCrossed;
    crossings[e][face] = contourParameter(view, {mesh.positions[v[0]], mesh.positions[v[1]]},
                                          {mesh.normals[v[0]], mesh.normals[v[1]]});
  }
  if (!link.seam) crossings[e][1] = crossings[e][0];
  return state;
}

}  // namespace limn::silhouette
