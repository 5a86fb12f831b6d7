// Which triangles meet at which edge. Depends on indices, positions (for welding) and normals (for features)
// of the rest pose only; stays valid while a mesh deforms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "silhouette/mesh.h"

namespace limn::silhouette {

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Side k of a triangle runs from its corner k to its corner (k + 1) % 3.
struct Side {
  std::uint32_t triangle = kNone;
  std::uint32_t side = 0;
};

/// The index of the side after `side` = 3 · triangle + k, in the same triangle.
constexpr std::uint32_t nextInTriangle(std::uint32_t side) {
  return side % 3 == 2 ? side - 2 : side + 1;
}

struct Edge {
  /// Welded points at the ends, point[0] < point[1].
  std::array<std::uint32_t, 2> point{};
  /// faces[0] runs point[0] -> point[1] and faces[1] back. faces[1] is absent (triangle == kNone) on a
  /// boundary, where faces[0] may run either way.
  std::array<Side, 2> faces{};
  bool descending = false;   ///< boundaries: faces[0] runs point[1] -> point[0]
  bool boundary = false;     ///< one face only
  bool nonManifold = false;  ///< more than two faces, inconsistent orientation, or a degenerate triangle
                             ///< among the faces: each face gets an edge of its own, treated as a boundary,
                             ///< and never curved (alpha = 0), so that all copies stay together
  /// Per end: the two faces have different shading normals there.
  std::array<bool, 2> feature{};

  bool isFeature() const { return feature[0] || feature[1]; }
  /// Whether faces[face] runs point[1] -> point[0].
  bool runsBack(std::size_t face) const { return face == 1 || descending; }
};

/// The mesh's vertices at point[0] and point[1] as faces[0] and faces[1] use them: [face][end]. On a boundary
/// the one face's twice.
using EdgeVertices = std::array<std::array<std::uint32_t, 2>, 2>;
EdgeVertices edgeVertices(const Mesh& mesh, const Edge& edge);

struct TopologyReport {
  /// Repeated point, or zero area (height below 1e-12 of the longest side): drawn as they are, never refined.
  std::size_t degenerateTriangles = 0;
  std::size_t boundaryEdges = 0;     ///< without the non-manifold ones
  std::size_t nonManifoldEdges = 0;  ///< records: one per face that meets there
  std::size_t featureEdges = 0;
  std::size_t opposedTriangles = 0;  ///< that face against the mean of their shading normals
};

class Topology {
 public:
  /// Welds vertices by position (bit for bit, -0 equals +0) and finds the edges. Normals that differ by at
  /// most `featureDegrees`, 0 to 180, count as shared. Linear in vertices and triangles. Throws
  /// std::invalid_argument for indices out of range, arrays whose lengths do not agree, 2^32 - 1 or more vertices or
  /// indices.
  explicit Topology(const Mesh& mesh, float featureDegrees = 0.1f);

  std::size_t pointCount() const { return pointCount_; }
  const std::vector<std::uint32_t>& points() const { return points_; }  ///< welded point of each vertex
  /// By point[0], then point[1]; the copies of a non-manifold edge by their triangles.
  const std::vector<Edge>& edges() const { return edges_; }
  /// Edge of each side, three per triangle; kNone on degenerate triangles.
  const std::vector<std::uint32_t>& sideEdges() const { return sideEdges_; }
  bool isDegenerate(std::size_t triangle) const { return degenerate_[triangle] != 0; }
  const TopologyReport& report() const { return report_; }

  /// Every cross-reference agrees with every other.
  bool isConsistent(const Mesh& mesh) const;

 private:
  void findEdges(const Mesh& mesh);
  void addEdges(const Mesh& mesh, std::span<const std::uint32_t> group);
  void findFeatures(const Mesh& mesh, float featureDegrees);

  std::size_t pointCount_ = 0;
  std::vector<std::uint32_t> points_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> sideEdges_;
  std::vector<std::uint8_t> degenerate_;
  TopologyReport report_;
};

}  // namespace limn::silhouette
