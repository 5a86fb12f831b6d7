// Edges that have vertices of their own in a view: samples of a curve, and silhouette points.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III.C-D.
// Differs in: an edge has a silhouette point for each of its faces, because the normals may differ across it
// (features, texture seams); where they do not it is the same one. A point that falls within kSnap of the
// tolerance of an end of the edge, of a sample or of the other face's point becomes that vertex: decided here, once per
// edge, so both faces see the same.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "silhouette/contour.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/remesh.h"
#include "silhouette/writer.h"

namespace limn::silhouette {

inline constexpr float kSnap = 0.25f;  ///< of the tolerance in pixels

/// A vertex on an edge. Without initial values: lists of them are long and mostly empty.
struct EdgeVertex {
  float t;               ///< from point[0] to point[1], in (0, 1)
  std::uint32_t sample;  ///< k of the curve's polyline; 0: a silhouette point
};
using EdgeVertexList = std::array<EdgeVertex, kMaxSideVertices>;

struct CrossedEdge {
  std::uint32_t edge = 0;
  float alpha = 1;                   ///< share of the curve that is shown
  std::uint32_t segments = 1;        ///< of the curve's polyline
  std::array<bool, 2> crosses{};     ///< per face: it has a silhouette point
  std::array<float, 2> parameter{};  ///< of the silhouette point, or of the vertex that it became
  std::uint32_t points = 0;          ///< where it crosses: EdgeSearch::points, before they became vertices
  std::array<std::uint32_t, 2>
      rank{};                     ///< where it is: 0 = point[0], 1 … count a vertex, count + 1 = point[1]
  std::uint32_t count = 0;        ///< vertices between the ends
  std::uint32_t firstVertex = 0;  ///< in the stream; count of them, or twice that
  bool seam = false;              ///< the faces have vertices of their own, those of faces[1] second
  std::array<bool, 2> own{};      ///< per face: the silhouette point is a vertex that nothing else is

  std::uint32_t vertexCount() const { return seam ? 2 * count : count; }
};

/// The straight line and the curve of an edge.
struct EdgeCurve {
  std::array<glm::vec3, 2> ends;
  CurveOffsets offsets;

  glm::vec3 point(float t) const { return curvePoint(ends[0], ends[1], offsets, t); }
  glm::vec3 sample(std::uint32_t k, std::uint32_t segments) const {
    return polylineVertex(ends[0], ends[1], offsets, static_cast<int>(k), static_cast<int>(segments));
  }
};

/// What a view shows of an edge's curve between its vertices. Without a silhouette point α of it is added to the chord; with
/// one, to the line that goes from end to end over that point, since this is what the edge shows when α is 0.
struct ShownCurve {
  EdgeCurve bridge;
  float alpha = 1;
  float peak = 0;  ///< parameter of the silhouette point; 0: none

  glm::vec3 sample(std::uint32_t k, std::uint32_t segments) const;
};

/// Lets silhouette points become vertices that are within `snap` pixels of them, and ranks them. An end may take
/// points when `open[end]`.
void settle(CrossedEdge& edge, const ShownCurve& shown, const std::array<bool, 2>& open,
            const PixelBound& bound, float snap);

/// The vertices between the ends, in order. Returns their number.
std::size_t listVertices(const CrossedEdge& edge, EdgeVertexList& list);

}  // namespace limn::silhouette
