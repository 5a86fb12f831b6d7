// An edge that bends in a view: one record from which both its triangles take the same points.
#pragma once

#include <array>
#include <cstdint>

#include "silhouette/edge_curves.h"
#include "silhouette/topology.h"

namespace limn::silhouette {

struct SmoothEdge {
  std::uint32_t edge = kNone;
  std::uint32_t firstSide = kNone;      ///< 3 · triangle + side of its first face
  std::array<std::uint32_t, 2> ends{};  ///< vertices at point[0] and point[1], of the first face
  float alpha = 0;
  float inverse = 1;       ///< 1 / α
  CurveOffsets offsets{};  ///< α d
  std::uint32_t segments = 1;
  std::uint32_t firstVertex = 0;  ///< in the stream: of segments - 1, or twice that
  float scale = 0;                ///< pixels that a unit of the model measures at most near it
  bool seam = false;        ///< the faces have vertices of their own, those of the second face come second
  bool descending = false;  ///< as in Edge

  bool bends() const { return edge != kNone; }
  std::uint32_t inner() const { return segments - 1; }
  std::uint32_t vertexCount() const { return seam ? 2 * inner() : inner(); }
  /// Whether `side` is its second face's, and whether it runs from point[1] to point[0].
  bool isSecond(std::uint32_t side) const { return side != firstSide; }
  bool runsBack(std::uint32_t side) const { return isSecond(side) || descending; }
};

/// Of a triangle's sides: a default one where a side does not bend.
using Records = std::array<const SmoothEdge*, 3>;

/// The vertices along a side of a triangle, in its direction.
struct SidePoints {
  std::uint32_t from, to, first, segments;
  bool backwards;

  std::uint32_t operator()(std::uint32_t i) const {
    if (i == 0) return from;
    if (i == segments) return to;
    return first + (backwards ? segments - 1 - i : i - 1);
  }
};

}  // namespace limn::silhouette
