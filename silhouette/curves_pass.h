// One view's refinement by silhouette curves: what its steps work on and hand to each other.
//
// Visible vertices and crossed edges (edge_search.h) → the edges' records and silhouette points → silhouette triangles and
// their segments → lowered points → vertices on edges → pieces. curves_edges.cpp, curves_segments.cpp and curves_pieces.cpp
// have the steps. Every step counts, sums and fills by blocks of indices, so the stream is the same for any number of
// threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "raster/base/check.h"
#include "silhouette/crossed_edges.h"
#include "silhouette/curve_set.h"
#include "silhouette/edge_search.h"
#include "silhouette/patch.h"
#include "silhouette/view_pass.h"

namespace limn::silhouette {

/// All that it refers to outlives it.
struct CurvesPass : ViewPass {
  static constexpr std::array<float, 3> kLinear{};  ///< normals: what is curved here is the outline

  /// The curve across a silhouette triangle, from the side that leaves the lone corner to the one that comes back.
  struct Segment {
    bool exists = false;
    std::uint32_t lone = 0;
    std::array<SegmentEnd, 2> ends{};  // before they became vertices near them
    std::array<glm::vec2, 2> weights{};
    CurveOffsets offsets{};
    std::uint32_t steps = 1;
  };

  /// Where the pieces of a triangle begin in the stream.
  struct Slot {
    std::uint32_t vertex = 0, triangle = 0;
  };

  /// Memory that is kept from view to view.
  struct Scratch {
    EdgeSearch search;
    std::vector<std::uint32_t> blockCounts;  // then their prefix sums
    std::vector<CrossedEdge> edges;
    std::vector<std::uint32_t> recordOf;   // per edge: index into edges, or kNone
    std::vector<std::uint32_t> triangles;  // that are replaced, ascending
    std::vector<Segment> segments;         // of the triangles with crossed edges
    std::vector<std::uint32_t> segmentOf;  // per triangle: index into segments, or kNone
    std::vector<std::uint32_t> segmentTriangles;
    std::vector<BlockingPlane> planes;
    std::vector<std::uint32_t> loweredOf;  // per vertex of the mesh: its vertex in the stream, or kNone
    std::vector<std::uint32_t> lowered;    // the vertices that have one
    std::vector<Slot> slots;               // per replaced triangle, then the end
  };

  /// A side of a triangle as the edge record sees it.
  struct SideView {
    const CrossedEdge* edge = nullptr;
    std::size_t face = 0;
    bool back = false;  // the side runs against the edge

    std::size_t count() const { return edge == nullptr ? 0 : edge->count; }
    // A position along the edge as one along the side.
    std::size_t rank() const {
      LIMN_ASSERT(edge != nullptr);
      return back ? edge->count + 1 - edge->rank[face] : edge->rank[face];
    }
    float parameter() const { return back ? 1.0f - edge->parameter[face] : edge->parameter[face]; }
    std::uint32_t vertex(std::size_t k) const {  // k-th on the side, from 0
      const auto along = static_cast<std::uint32_t>(back ? edge->count - 1 - k : k);
      return edge->firstVertex + (edge->seam && face == 1 ? edge->count : 0) + along;
    }
  };
  using SideViews = std::array<SideView, 3>;

  const CurveSet& prepared;
  Scratch& scratch;

  void run();

 private:
  void forgetRecords();

  // curves_edges.cpp
  void findEdges();
  CrossedEdge crossedEdge(std::size_t candidate) const;
  void reportCapped(std::size_t count);
  void listReplaced(std::vector<std::uint32_t>& triangles);
  void placeEdges();
  void emitEdge(const CrossedEdge& edge);

  // curves_segments.cpp
  void findSegments();
  Segment segmentOf(std::uint32_t triangle) const;
  Patch fittedPatch(std::uint32_t triangle) const;
  void lowerPoints();
  void addPlanes(std::uint32_t triangle, const Segment& segment);
  void lower(std::uint32_t point, const glm::vec3& displacement);

  // curves_pieces.cpp
  void placePieces();
  Slot sizeOf(std::uint32_t triangle) const;
  bool cutOf(std::uint32_t triangle, const SideViews& sides, Cut& cut) const;
  void setOutline(std::uint32_t triangle, const SideViews& sides, Outline& outline) const;
  void emitPieces(std::size_t k);
  void writeCentre(std::uint32_t at, std::uint32_t triangle, const SideViews& sides);
  void listContour();

  std::uint32_t firstNew() const { return static_cast<std::uint32_t>(mesh.positions.size()); }
  std::uint32_t drawnVertex(std::uint32_t v) const {  // of a vertex of the mesh
    return scratch.loweredOf[v] == kNone ? v : firstNew() + scratch.loweredOf[v];
  }

  // The curve that silhouette points lie on.
  EdgeCurve bridgeOf(const CrossedEdge& record) const {
    const std::array<std::uint32_t, 2>& ends = prepared.vertices[record.edge][0];
    return {{mesh.positions[ends[0]], mesh.positions[ends[1]]}, prepared.curves[record.edge]};
  }

  ShownCurve shownOf(const CrossedEdge& record) const {
    ShownCurve shown{bridgeOf(record), record.alpha};
    for (std::size_t face = 0; face < 2 && shown.peak == 0.0f; ++face)
      if (record.crosses[face]) shown.peak = scratch.search.points[record.points][face].parameter;
    return shown;
  }

  // The curve that steps are counted for.
  EdgeCurve curveOf(const CrossedEdge& record) const {
    const std::array<std::uint32_t, 2>& ends = prepared.vertices[record.edge][0];
    const CurveOffsets& offsets = prepared.curves[record.edge];
    return {{mesh.positions[ends[0]], mesh.positions[ends[1]]},
            {record.alpha * offsets[0], record.alpha * offsets[1]}};
  }

  SideView sideOf(std::uint32_t triangle, std::size_t side) const {
    const std::uint32_t e = topology.sideEdges()[3 * std::size_t{triangle} + side];
    const std::uint32_t record = e == kNone ? kNone : scratch.recordOf[e];
    if (record == kNone) return {};
    const Edge& edge = topology.edges()[e];
    const std::size_t face = edge.faces[1].triangle == triangle && edge.faces[1].side == side ? 1 : 0;
    return {&scratch.edges[record], face, edge.runsBack(face)};
  }
  SideViews sidesOf(std::uint32_t triangle) const {
    return {sideOf(triangle, 0), sideOf(triangle, 1), sideOf(triangle, 2)};
  }
};

}  // namespace limn::silhouette
