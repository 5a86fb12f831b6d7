#include "silhouette/edge_search.h"

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
  // On a fine mesh that is nearly every edge by the contour, and telling costs less than looking around it.
  const auto isSeen = [&](std::size_t e) {
    const std::array<std::uint32_t, 2>& ends = curves.links[e].ends;
    return parameters.segments > 0 ||
           bound.curveError(mesh.positions[ends[0]], mesh.positions[ends[1]], curves.curves[e]).bend >
               kUnseen * parameters.tolerance;
  };
  crew.forBlocks(edges, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) states[e] = stateOf(e, mesh, curves, view, largest);
  });
  crew.forBlocks(edges, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (states[e] == 0) continue;
      const EdgeLink& link = curves.links[e];
      const bool mayBend = (states[e] & kMayBend) != 0, crossed = (states[e] & kCrossed) != 0;
      const bool looks = mayBend && !link.always && isSeen(e);
      alphas[e] = link.always ? 1.0f : looks ? ring.alpha(static_cast<std::uint32_t>(e)) : 0.0f;
      if (alphas[e] > 0.0f || (crossed && link.bridged)) states[e] |= kListed;
    }
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
