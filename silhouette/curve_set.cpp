#include "silhouette/curve_set.h"

#include "silhouette/face_normal.h"
#include "silhouette/feature_curves.h"

namespace limn::silhouette {
namespace {

constexpr std::size_t kItemsPerBlock = 4096;

}  // namespace

void CurveSet::prepare(const Mesh& mesh, const Topology& topology, const Parameters& parameters,
                       const Crew& crew) {
  const std::vector<Edge>& edges = topology.edges();
  computeEdgeCurves(mesh, topology, {Tangents::kCircular, parameters.robust}, crew, robust_, curves);
  computeFeatureCurves(mesh, topology, crew, curves);
  vertices.resize(edges.size());
  trust.resize(edges.size());
  always.resize(edges.size());
  bridged.resize(edges.size());
  crew.forBlocks(edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = edges[e];
      vertices[e] = edgeVertices(mesh, edge);
      if ((edge.isFeature() && !parameters.features) || (edge.boundary && !parameters.boundaries))
        curves[e] = {};
      const bool bends = curves[e] != CurveOffsets{};
      always[e] = bends && (edge.isFeature() || edge.boundary) ? 1 : 0;
      const bool doubtful = parameters.robust && !edge.isFeature() && !edge.nonManifold;
      trust[e] = doubtful ? robust_.factors(edge) : std::array{1.0f, 1.0f};
      // Where normals are not believed at all the mesh stays as it is, to the last bit.
      bridged[e] = edge.nonManifold || (trust[e][0] == 0.0f && trust[e][1] == 0.0f) ? 0 : 1;
    }
  });
  faceNormals.resize(mesh.triangleCount());
  crew.forBlocks(faceNormals.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      faceNormals[t] = topology.isDegenerate(t) ? glm::vec3(0.0f) : faceNormal(mesh, t);
  });
  blocking.prepare(mesh, topology);
}

}  // namespace limn::silhouette
