// Silhouetteness α of edges: how much of an edge's smooth curve is shown from a viewpoint.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, (1)-(3).
// Differs in: f is computed without the square root, from the vector to the eye instead of the unit view
// vector; β of (3) is clamped at 0 where the wedge would reach past the surface; a contour variant, in which
// f is the product of the least and the greatest facing of the shading normals over the corners of the edge's
// faces.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/method.h"

namespace limn::silhouette {

/// (2), with the binary test for β = 0.
inline float silhouettenessOf(float f, float beta) {
  if (f <= 0.0f) return 1.0f;
  if (f >= beta) return 0.0f;
  return 1.0f - f / beta;
}

/// β of (3) from the unit normals of the two faces; sinφ and cosφ of the wedge.
float wedgeBeta(const glm::vec3& ns, const glm::vec3& nt, float sinPhi, float cosPhi);

/// The view-independent part of the test, for all edges of a mesh.
class EdgeTest {
 public:
  /// `parameters` decide β and which edges are always or never smooth.
  void prepare(const Mesh& mesh, const Topology& topology, const Parameters& parameters, const Crew& crew);

  /// α of edge `e` in a view.
  float alpha(const View& view, const Parameters& parameters, std::size_t e) const;

  /// The unit normals of the triangles; zero for degenerate ones.
  const std::vector<glm::vec3>& faceNormals() const { return faceNormals_; }

  /// f of (1).
  float byEdge(const View& view, const Edge& edge) const;
  float beta(const Parameters& parameters, std::size_t e) const {
    return betas_.empty() ? parameters.beta : betas_[e];
  }
  float largestBeta(const Parameters& parameters) const;

 private:
  float byContour(const View& view, const Edge& edge) const;
  void widen(const View& view, std::size_t triangle, float& low, float& high) const;

  Mesh mesh_;
  const Topology* topology_ = nullptr;
  std::vector<glm::vec3> faceNormals_;
  std::vector<float> betas_;  // per edge; empty where it is Parameters::beta for all
};

}  // namespace limn::silhouette
