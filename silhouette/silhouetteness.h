// Silhouetteness α of edges: how much of an edge's smooth curve is shown from a viewpoint.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, (1)-(3).
// Differs in: f is computed without the square root, from the vector to the eye instead of the unit view
// vector; β of (3) is clamped at 0 where the wedge would reach past the surface; and two variants look at where the
// smooth shape's silhouette, the zero set of the facing g of the shading normals, runs:
//
//  * contour   f is the product of the least and the greatest facing over the corners of the edge's faces.
//  * crossing  α = 1 where the contour crosses the edge. Where it crosses a face beside the edge instead, α falls from 1,
//    when it runs along the edge, to 0, when it reaches the opposite corner: c/(c + 0.6 m) with c the facing of that corner
//    beyond zero and m the harmonic mean of the ends' facings, which is the contour's distance from the edge in heights
//    of the triangle. Where it crosses no face, α = 1 - f/β with f = m over the spread of the four facings, so that an
//    edge is whole when the contour comes to it over an end. All lengths are shares of the mesh's own, so the finer the
//    mesh, the narrower the transition: fewer edges bend for the same outline.
#pragma once

#include <algorithm>
#include <cmath>
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

/// Facings at an edge: the least and the greatest of its ends, and of the corners opposite to it in its faces.
struct EdgeFacings {
  float low, high;
  float opposite[2];
};

/// The second variant of the silhouetteness.
inline float contourSilhouetteness(const EdgeFacings& g, float beta) {
  const float low = std::min(g.low, std::min(g.opposite[0], g.opposite[1]));
  const float high = std::max(g.high, std::max(g.opposite[0], g.opposite[1]));
  return silhouettenessOf(low * high, beta);
}

/// Slows crossing's fade within a face. With 1 instead, 3 % fewer triangles are drawn and the outline of knot-480 gains half
/// a percentage point less.
inline constexpr float kFadeShare = 0.6f;

/// The third variant of the silhouetteness. `beta` >= 0; with 0 the transition outside crossed faces is gone.
inline float crossingSilhouetteness(const EdgeFacings& g, float beta) {
  if (g.low <= 0.0f && g.high >= 0.0f) return 1.0f;
  const float a = std::fabs(g.low), b = std::fabs(g.high), ends = 2.0f * (a / (a + b)) * b;
  const float most = std::max(g.opposite[0], g.opposite[1]), least = std::min(g.opposite[0], g.opposite[1]);
  const float beyond = g.low > 0.0f ? -least : most;
  const float within = beyond > 0.0f ? beyond / (beyond + kFadeShare * ends) : 0.0f;
  const float spread = std::max(g.high, most) - std::min(g.low, least);
  const float outside = 1.0f - ends / (beta * spread);
  return outside > within ? outside : within;
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
  EdgeFacings facings(const View& view, const Edge& edge) const;

  Mesh mesh_;
  const Topology* topology_ = nullptr;
  std::vector<glm::vec3> faceNormals_;
  std::vector<float> betas_;  // per edge; empty where it is Parameters::beta for all
};

}  // namespace limn::silhouette
