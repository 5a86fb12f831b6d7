// Vertices that are lowered so that they do not hide a concave silhouette segment.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III.E,
// "Local perturbation". Differs in: only the vertices of the segment's own triangle move, by at most kReach of
// the shortest edge at the vertex; the planes of the paper are infinite, and vertices far above one were pushed
// through thin shapes. And everything is faded: the more a segment is concave, and the nearer it is to the
// vertex within the triangle, the more it counts, so that nothing jumps when a segment turns concave or leaves
// its triangle.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "silhouette/method.h"

namespace limn::silhouette {

/// The plane in which a concave segment lies, as one point of the mesh feels it.
struct BlockingPlane {
  std::uint32_t point = 0;
  std::uint32_t triangle = 0;  ///< whose segment it is
  float weight = 0;            ///< in (0, 1]
  glm::vec3 middle{0.0f};      ///< M, the segment's
  glm::vec3 normal{0.0f};      ///< N there, unit
};

/// How concave a segment is, 0 … 1: by its chord F and the unit normals at its ends.
float concavity(const glm::vec3& chord, const glm::vec3& n1, const glm::vec3& n2);

class Blocking {
 public:
  static constexpr float kReach = 0.15f;  ///< of the shortest edge at a vertex

  /// Finds the shortest edges, and which points stay: those of boundary, feature and non-manifold edges.
  void prepare(const Mesh& mesh, const Topology& topology);

  /// What is added to the point at `place`: nothing, or a vector of at most reach(point).
  glm::vec3 displacement(const glm::vec3& place, std::span<const BlockingPlane> planes) const;

  /// How much a segment counts for a corner whose weight at the segment's middle is `nearness`.
  static float nearnessWeight(float nearness);

  float reach(std::uint32_t point) const { return reach_[point]; }
  /// The sides that leave a point: side 3 t + k leaves corner k of triangle t.
  std::span<const std::uint32_t> sidesFrom(std::uint32_t point) const {
    return std::span(sides_).subspan(firstSide_[point], firstSide_[point + 1] - firstSide_[point]);
  }

 private:
  std::vector<float> reach_;  // 0 where a point stays
  std::vector<std::uint32_t> firstSide_, sides_;
};

}  // namespace limn::silhouette
