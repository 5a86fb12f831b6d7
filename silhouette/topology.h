// Which triangles meet at which edge. Depends on indices, positions (for welding) and normals (for features) of the
// rest pose only; stays valid while a mesh deforms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "silhouette/mesh.h"

namespace limn::silhouette {

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Side k of a triangle runs from its corner k to its corner (k + 1) % 3.
struct Side {
  std::uint32_t triangle = kNone;
  std::uint32_t side = 0;
};

struct Edge {
  /// Welded points at the ends, point[0] < point[1].
  std::array<std::uint32_t, 2> point{};
  /// The faces: faces[0] runs along the edge as point[0] -> point[1] where the mesh is consistently oriented; faces[1]
  /// is absent (triangle == kNone) on a boundary and on a non-manifold edge's second record.
  std::array<Side, 2> faces{};
  bool boundary = false;     ///< one face only
  bool nonManifold = false;  ///< more than two faces or inconsistent orientation: each face gets an edge of its own,
                             ///< treated as a boundary, and never curved (alpha = 0), so that all copies stay together
  /// Per end: the two faces have different shading normals there.
  std::array<bool, 2> feature{};

  bool isFeature() const { return feature[0] || feature[1]; }
};

struct TopologyReport {
  std::size_t degenerateTriangles = 0;  ///< repeated point or zero area: drawn as they are, never refined
  std::size_t boundaryEdges = 0;
  std::size_t nonManifoldEdges = 0;
  std::size_t featureEdges = 0;
  std::size_t opposedTriangles = 0;     ///< that face against the mean of their shading normals
};

class Topology {
 public:
  /// Welds vertices by position (bit for bit, -0 equals +0) and finds the edges. Normals that differ by at most
  /// `featureDegrees` count as shared. Throws std::invalid_argument for indices out of range.
  explicit Topology(const Mesh& mesh, float featureDegrees = 0.1f);

  std::size_t pointCount() const { return pointCount_; }
  const std::vector<std::uint32_t>& points() const { return points_; }      ///< welded point of each vertex
  const std::vector<Edge>& edges() const { return edges_; }
  /// Edge of each side, three per triangle; kNone on degenerate triangles.
  const std::vector<std::uint32_t>& sideEdges() const { return sideEdges_; }
  const TopologyReport& report() const { return report_; }

  /// Every cross-reference agrees with every other.
  bool isConsistent(const Mesh& mesh) const;

 private:
  std::size_t pointCount_ = 0;
  std::vector<std::uint32_t> points_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> sideEdges_;
  TopologyReport report_;
};

}  // namespace limn::silhouette
