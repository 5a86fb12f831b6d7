#include "silhouette/edge_curves.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace limn::silhouette {
namespace {

using glm::cross;
using glm::dot;
using glm::vec3;

constexpr std::size_t kEdgesPerBlock = 2048;

// Scales a projected tangent, whose length is |e| cos θ, to that of a circular arc, 2 |e| / (1 + cos θ).
// Steeper than 60 degrees the factor stays what it is there, so that the tangent vanishes with its projection
// instead of keeping its length while losing its direction.
float circularFactor(float cosine) {
  const float c = cosine > 0.5f ? cosine : 0.5f;
  return 2.0f / (c * (1.0f + c));
}

// Likewise for a geodesic-like tangent: of an arc's ends it has the length 3 |e| cos θ / (1 + 2 cos² θ).
float arcFactor(float cosine) {
  const float c = cosine > 0.5f ? cosine : 0.5f;
  return 2.0f * (1.0f + 2.0f * c * c) / (3.0f * c * (1.0f + c));
}

bool isArc(Tangents tangents) {
  return tangents == Tangents::kCircular || tangents == Tangents::kGeodesicArc;
}

// What the end adds to one third of `e`, given its tangent direction's projection of e.
vec3 offsetOf(const vec3& e, const vec3& projected, Tangents tangents) {
  if (!isArc(tangents)) return (projected - e) / 3.0f;
  const float length2 = dot(e, e);
  const float cosine = length2 > 0.0f ? std::sqrt(dot(projected, projected) / length2) : 1.0f;
  return (circularFactor(cosine) * projected - e) / 3.0f;
}

// Smooth end, (7): the edge projected into the tangent plane.
vec3 smoothOffset(const vec3& e, const vec3& n, Tangents tangents) {
  const float height = dot(e, n);
  if (height == 0.0f) return vec3(0.0f);
  if (!isArc(tangents)) return (-height / 3.0f) * n;
  return offsetOf(e, e - height * n, tangents);
}

// Feature end, (8): the edge projected on the line where the two tangent planes meet. The line is
// ill-conditioned for nearly parallel and for nearly opposed normals: there the end turns, between 1 and 1/4
// degree of the angle, into a smooth one of the mean normal (parallel) or into a straight one (opposed),
// continuously, so that nothing jumps when a mesh deforms.
vec3 featureOffset(const vec3& e, const EdgeEnd& end, Tangents tangents) {
  const vec3 product = cross(end.normal[1], end.normal[0]);
  const float sine2 = dot(product, product);
  const float weight = smoothStep(0.004363f, 0.017452f, std::sqrt(sine2));
  vec3 offset(0.0f);
  if (weight > 0.0f) offset = weight * offsetOf(e, (dot(e, product) / sine2) * product, tangents);
  if (weight < 1.0f && dot(end.normal[0], end.normal[1]) > 0.0f) {
    const vec3 mean = glm::normalize(end.normal[0] + end.normal[1]);
    offset += (1.0f - weight) * smoothOffset(e, mean, tangents);
  }
  return offset;
}

// Geodesic-like ends: the tangents a at i and b at j (thirds, pointing along the edge) are those of least
// bending energy among all cubics tangent to the surface, which makes the curve normal parallel to the
// surface normal at both ends. The conditions 2a + b - e || n_i and a + 2b - e || n_j, a ⟂ n_i, b ⟂ n_j give
// a 2 by 2 system whose determinant 4 - ⟨n_i,n_j⟩² is never below 3.
CurveOffsets geodesicOffsets(const vec3& e, const vec3& ni, const vec3& nj) {
  const float hi = dot(e, ni), hj = dot(e, nj), k = dot(ni, nj);
  const float determinant = 4.0f - k * k;
  const float lambda = -(2.0f * hi + k * hj) / determinant, mu = -(2.0f * hj + k * hi) / determinant;
  return {(2.0f * lambda * ni - mu * nj) / 3.0f, (lambda * ni - 2.0f * mu * nj) / 3.0f};
}

// Gives the tangent of a geodesic-like end the length that it has on a circular arc. `e` leaves the end.
vec3 arcOffset(const vec3& e, const vec3& offset) {
  if (offset == vec3(0.0f)) return offset;
  const vec3 tangent = e / 3.0f + offset;
  const float lengths2 = dot(tangent, tangent) * dot(e, e);
  const float cosine = lengths2 > 0.0f ? dot(tangent, e) / std::sqrt(lengths2) : 1.0f;
  return offset + (arcFactor(cosine) - 1.0f) * tangent;
}

EdgeEnd edgeEnd(const Mesh& mesh, const Edge& edge, const EdgeVertices& v, std::size_t end) {
  return {{mesh.normals[v[0][end]], mesh.normals[v[edge.feature[end] ? 1 : 0][end]]}, edge.feature[end]};
}

}  // namespace

CurveOffsets edgeCurve(const vec3& pi, const vec3& pj, const EdgeEnd& atI, const EdgeEnd& atJ,
                       const CurveStyle& style) {
  const vec3 e = pj - pi;
  const bool isGeodesic = style.tangents == Tangents::kGeodesic || style.tangents == Tangents::kGeodesicArc;
  if (isGeodesic && !atI.feature && !atJ.feature) {
    const CurveOffsets d = geodesicOffsets(e, atI.normal[0], atJ.normal[0]);
    if (style.tangents == Tangents::kGeodesic) return d;
    return {arcOffset(e, d[0]), arcOffset(-e, d[1])};
  }
  const auto offset = [&](const vec3& along, const EdgeEnd& end) {
    return end.feature ? featureOffset(along, end, style.tangents)
                       : smoothOffset(along, end.normal[0], style.tangents);
  };
  return {offset(e, atI), offset(-e, atJ)};
}

void computeEdgeCurves(const Mesh& mesh, const Topology& topology, const CurveStyle& style, const Crew& crew,
                       RobustEnds& robust, std::vector<CurveOffsets>& curves) {
  if (style.robust) robust.prepare(mesh, topology, crew);
  const std::vector<Edge>& edges = topology.edges();
  curves.resize(edges.size());
  crew.forBlocks(edges.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = edges[e];
      curves[e] = {};
      if (edge.nonManifold) continue;
      const EdgeVertices v = edgeVertices(mesh, edge);
      curves[e] = edgeCurve(mesh.positions[v[0][0]], mesh.positions[v[0][1]], edgeEnd(mesh, edge, v, 0),
                            edgeEnd(mesh, edge, v, 1), style);
      if (!style.robust || edge.isFeature()) continue;
      const std::array<float, 2> factors = robust.factors(edge);
      for (std::size_t k = 0; k < 2; ++k) curves[e][k] *= factors[k];
    }
  });
}

void placeFittedCurves(const Mesh& mesh, const Topology& topology, const FittedCurves& fitted,
                       const Crew& crew, std::vector<CurveOffsets>& curves, std::vector<vec3>& centers) {
  curves.resize(topology.edges().size());
  centers.resize(mesh.triangleCount());
  crew.forBlocks(curves.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = topology.edges()[e];
      const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, edge)[0];
      const std::array<vec3, 2> normals = endNormals(mesh, edge);
      curves[e] = edge.nonManifold ? CurveOffsets{}
                                   : fittedOffsets(mesh.positions[ends[0]], mesh.positions[ends[1]],
                                                   normals[0], normals[1], fitted.edges[e]);
    }
  });
  crew.forBlocks(centers.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t* corner = &mesh.indices[3 * t];
      centers[t] = fittedCenter(mesh.positions[corner[0]], mesh.positions[corner[1]],
                                mesh.positions[corner[2]], fitted.centers[t]);
    }
  });
}

}  // namespace limn::silhouette
