#include "silhouette/silhouetteness.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "raster/base/elementary.h"
#include "silhouette/contour.h"
#include "silhouette/face_normal.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr std::size_t kItemsPerBlock = 4096;

}  // namespace

float wedgeBeta(const vec3& ns, const vec3& nt, float sinPhi, float cosPhi) {
  const float sinTheta = glm::length(glm::cross(ns, nt)), cosTheta = dot(ns, nt);
  return std::max(0.0f, sinPhi * cosPhi * sinTheta + sinPhi * sinPhi * cosTheta);
}

void EdgeTest::prepare(const Mesh& mesh, const Topology& topology, const Parameters& parameters,
                       const Crew& crew) {
  mesh_ = mesh;
  topology_ = &topology;
  computeFaceNormals(mesh, topology, crew, faceNormals_);
  betas_.assign(parameters.edgeBetas.begin(), parameters.edgeBetas.end());
  if (!betas_.empty() || parameters.wedgeDegrees == 0.0f) return;
  const SinCos phi = sinCosDegrees(parameters.wedgeDegrees);
  const std::vector<Edge>& edges = topology.edges();
  betas_.resize(edges.size());
  crew.forBlocks(edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      betas_[e] = edges[e].boundary ? 0.0f
                                    : wedgeBeta(faceNormals_[edges[e].faces[0].triangle],
                                                faceNormals_[edges[e].faces[1].triangle],
                                                static_cast<float>(phi.sin), static_cast<float>(phi.cos));
  });
}

// (1). At the edge's midpoint the view vector is zero, so is f, and α = 1.
float EdgeTest::byEdge(const View& view, const Edge& edge) const {
  const std::array<std::uint32_t, 2> ends = edgeVertices(mesh_, edge)[0];
  const vec3 v = towardsEye(view, 0.5f * (mesh_.positions[ends[0]] + mesh_.positions[ends[1]]));
  const float length2 = dot(v, v);
  const float product =
      dot(v, faceNormals_[edge.faces[0].triangle]) * dot(v, faceNormals_[edge.faces[1].triangle]);
  return length2 > 0.0f ? product / length2 : 0.0f;
}

EdgeFacings EdgeTest::facings(const View& view, const Edge& edge) const {
  const auto at = [&](const Side& face, std::uint32_t corner) {
    const std::uint32_t vertex = mesh_.indices[3 * face.triangle + (face.side + corner) % 3];
    const vec3 v = towardsEye(view, mesh_.positions[vertex]);
    const float length2 = dot(v, v);
    return length2 > 0.0f ? dot(v, mesh_.normals[vertex]) / std::sqrt(length2) : 0.0f;
  };
  EdgeFacings g{2.0f, -2.0f, {}};
  for (std::size_t face = 0; face < 2; ++face) {
    for (std::uint32_t end = 0; end < 2; ++end) {
      const float facing = at(edge.faces[face], end);
      g.low = std::min(g.low, facing);
      g.high = std::max(g.high, facing);
    }
    g.opposite[face] = at(edge.faces[face], 2);
  }
  return g;
}

float EdgeTest::largestBeta(const Parameters& parameters) const {
  return betas_.empty() ? parameters.beta : *std::max_element(betas_.begin(), betas_.end());
}

float EdgeTest::alpha(const View& view, const Parameters& parameters, std::size_t e) const {
  const Edge& edge = topology_->edges()[e];
  if (edge.nonManifold) return 0.0f;
  if (edge.boundary) return parameters.boundaries ? 1.0f : 0.0f;
  if (parameters.features && edge.isFeature()) return 1.0f;
  if (parameters.silhouetteness == Silhouetteness::kEdge)
    return silhouettenessOf(byEdge(view, edge), beta(parameters, e));
  const EdgeFacings g = facings(view, edge);
  return parameters.silhouetteness == Silhouetteness::kContour
             ? contourSilhouetteness(g, beta(parameters, e))
             : crossingSilhouetteness(g, beta(parameters, e));
}

}  // namespace limn::silhouette
