// Edge curves and patch centres that were fitted to a finer surface beforehand, kept in frames that move with
// the mesh.
//
// Based on: the edge curves and the patch of C. Dyken, M. Reimers, "Real-time linear silhouette enhancement",
// 2004, (7) and section 5. Differs in: the inner control points are data. Each is kept relative to what the
// mesh's own positions and normals say, so that a deforming mesh carries its curves along: with e = p_j -
// p_i, L = |e|, ê = e / L, the ends' normals n_i, n_j (of a feature end the mean of its faces'), up = the
// part of n_i + n_j across e, normalised, h_i = ⟨ê, n_i⟩,
//
//     c_ij = l_ij + L (x ê + (y - h_i / 3) up + z ê × up)                                   (F1)
//
// where (x, y, z) is stored, and c_ji is the same seen from j. y = 0 is the height of the projected tangent
// (7), so a curve bends with the normals when a joint does, and flattens with them under a non-uniform scale.
// The centre is
//
//     b111 = its value in the patch without it + x (p_1 - p_0) + y (p_2 - p_0) + z N / √|N|,                  (F2)
//     N = (p_1 - p_0) × (p_2 - p_0)
//
// Where the normals leave no direction across the edge the end is straight.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "silhouette/mesh.h"
#include "silhouette/topology.h"

namespace limn::silhouette {

/// (x, y, z) of (F1) at both ends of an edge.
using FittedEnds = std::array<glm::vec3, 2>;

/// Borrowed arrays of a mesh's fitted curves; empty where it has none. All numbers finite, |x|, |y|, |z| <=
/// kFittedLimit: the caller's duty, nothing checks them.
struct FittedCurves {
  std::span<const FittedEnds> edges;   ///< one per edge of the topology, at point[0] and point[1]
  std::span<const glm::vec3> centers;  ///< one per triangle, (F2)

  bool empty() const { return edges.empty() && centers.empty(); }
};

/// No fitted number is larger: a curve stays within two edge lengths of its edge, whatever a file says.
inline constexpr float kFittedLimit = 1.0f;

/// c_ij - l_ij and c_ji - l_ji by (F1), from unit normals at the ends.
std::array<glm::vec3, 2> fittedOffsets(const glm::vec3& pi, const glm::vec3& pj, const glm::vec3& ni,
                                       const glm::vec3& nj, const FittedEnds& ends);
/// The stored numbers that give these offsets back, zero at straight ends; the inverse of fittedOffsets but
/// for rounding.
FittedEnds fittedEnds(const glm::vec3& pi, const glm::vec3& pj, const glm::vec3& ni, const glm::vec3& nj,
                      const std::array<glm::vec3, 2>& offsets);

/// What (F2) adds to b111 of a triangle.
glm::vec3 fittedCenter(const glm::vec3& p0, const glm::vec3& p1, const glm::vec3& p2,
                       const glm::vec3& center);
/// Its inverse; zero for a triangle without area.
glm::vec3 fittedCenterOf(const glm::vec3& p0, const glm::vec3& p1, const glm::vec3& p2,
                         const glm::vec3& offset);

/// The unit normals at the ends of an edge that (F1) wants: at a feature end the mean of the faces', the
/// first face's where they cancel.
std::array<glm::vec3, 2> endNormals(const Mesh& mesh, const Edge& edge);

/// The edges in the order in which a walk over the triangles' sides (triangle 0 side 0, 1, 2, triangle 1, …)
/// first meets them, as indices into topology.edges(); `runsBack` (optional) says for each whether that side
/// runs from point[1] to point[0]. This is the order in which files keep fitted ends, and it depends on
/// positions and indices alone.
std::vector<std::uint32_t> edgesAsFirstMet(const Mesh& mesh, const Topology& topology,
                                           std::vector<bool>* runsBack = nullptr);

}  // namespace limn::silhouette
