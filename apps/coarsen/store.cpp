#include "apps/coarsen/store.h"

#include "silhouette/fitted_curves.h"

namespace limn::coarsen {
namespace {

using glm::dvec3;
using glm::vec3;

}  // namespace

void storeCurves(const PatchNet& net, const std::vector<Index>& triangles, scene::Mesh& coarse) {
  const silhouette::Mesh mesh{coarse.positions, coarse.normals, coarse.indices};
  const silhouette::Topology topology(mesh);
  const auto position = [&](std::size_t triangle, std::size_t corner) {
    return coarse.positions[coarse.indices[3 * triangle + corner]];
  };

  std::vector<silhouette::FittedEnds> ends(topology.edges().size(), {vec3(0.0f), vec3(0.0f)});
  std::vector<vec3> centers(mesh.triangleCount(), vec3(0.0f));
  for (std::size_t t = 0; t < net.triangleCount(); ++t) {
    const std::size_t triangle = triangles[t];
    if (topology.isDegenerate(triangle)) continue;
    const PerControl<Index> id = net.controlsOf(t);
    static constexpr std::array<std::array<std::size_t, 2>, 3> kEnds = {{{3, 4}, {5, 6}, {7, 8}}};
    for (std::size_t side = 0; side < 3; ++side) {
      const Index e = topology.sideEdges()[3 * triangle + side];
      const silhouette::Edge& edge = topology.edges()[e];
      if (edge.nonManifold) continue;
      const vec3 p = position(triangle, side), q = position(triangle, (side + 1) % 3);
      const vec3 fromStart(net.controls[id[kEnds[side][0]]] - (2.0 * dvec3(p) + dvec3(q)) / 3.0);
      const vec3 fromEnd(net.controls[id[kEnds[side][1]]] - (dvec3(p) + 2.0 * dvec3(q)) / 3.0);
      const std::array<vec3, 2> normals = silhouette::endNormals(mesh, edge);
      const bool back = topology.points()[coarse.indices[3 * triangle + side]] != edge.point[0];
      ends[e] = back ? silhouette::fittedEnds(q, p, normals[0], normals[1], {fromEnd, fromStart})
                     : silhouette::fittedEnds(p, q, normals[0], normals[1], {fromStart, fromEnd});
    }
    centers[triangle] =
        silhouette::fittedCenterOf(position(triangle, 0), position(triangle, 1), position(triangle, 2),
                                   vec3(net.controls[net.centerControl(t)] - net.defaultCenter(t)));
  }

  std::vector<bool> runsBack;
  const std::vector<Index> order = silhouette::edgesAsFirstMet(mesh, topology, &runsBack);
  std::vector<vec3> asMet;
  asMet.reserve(2 * order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    asMet.push_back(ends[order[k]][runsBack[k] ? 1 : 0]);
    asMet.push_back(ends[order[k]][runsBack[k] ? 0 : 1]);
  }
  coarse.curves.ends = scene::encodeAll(asMet, coarse.curves.endScale);
  coarse.curves.centers = scene::encodeAll(centers, coarse.curves.centerScale);
}

}  // namespace limn::coarsen
