// How normals turn along the edges around a point, as a function of direction: a curvature tensor.
//
// Based on: H. Moreton, C. Séquin, "Functional optimization for fair surface design", 1992, appendix: the second fundamental
// form that fits the normal curvatures along a point's edges best. Differs in: the curvature along an edge is how much the
// normal differs at its other end, edges count by 1 / length², and the form is drawn to 0 by a 50th of all that they weigh, so that
// two edges determine one as well.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/method.h"

namespace limn::silhouette {

class RingCurvature {
 public:
  /// `ups`, of points, are normals of the planes in which directions count, of any length; points that are not `wanted` have
  /// no curvature.
  void prepare(const Mesh& mesh, const Topology& topology, const std::vector<glm::vec3>& ups,
               const std::vector<std::uint8_t>& wanted, const Crew& crew);

  /// By what angle, in radians, the normal would turn along the edge `e` from a point, were the curvature the same all along it.
  float turn(std::uint32_t point, const glm::vec3& e) const;

 private:
  // The form is (a b; b c). Sums of the weighted products of (u², 2uv, v²) with each other and with the curvature,
  // where (u, v) is the edge's direction; then a, b, c.
  using Sums = std::array<float, 8>;
  struct Frame {
    glm::vec3 u{0.0f}, v{0.0f};  // unit; zero without a plane
  };
  static Frame frameOf(const glm::vec3& up);
  static glm::vec2 directionOf(const glm::vec3& e, const Frame& frame);
  static void add(Sums& sums, const Frame& frame, const glm::vec3& e, const glm::vec3& difference);
  static void solve(Sums& sums);

  std::vector<Sums> sums_;     // per point
  std::vector<Frame> frames_;  // likewise, of the planes
  float scale_ = 0;            // of lengths: mean edges are 1 long, so that no product is beyond floats
};

}  // namespace limn::silhouette
