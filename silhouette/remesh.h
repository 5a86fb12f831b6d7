// One triangle cut into several along the points on its sides and the silhouette segment inside it.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III.E and
// figures 11 and 12. Differs in: the strip's diagonals turn at the sample that is nearest to the far side as
// the viewer sees it, which folds nothing whether the segment bulges outwards or inwards; any number of points
// on any side, and segments that end at a corner, are handled; where both meet, ears are clipped: in the
// triangle's own plane of weights, in which the sides and the segment are straight lines and "on one line" is a
// matter of bookkeeping, never of rounding; and in such an order that, as the viewer sees it, no diagonal passes outside a
// segment or side that bends inwards, which would hide it.
//
// Topology apart from geometry: which vertices a side has belongs to the edge, so two triangles at an edge
// always insert the same ones, and the stream is watertight whatever the positions are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "silhouette/pixel_bound.h"
#include "silhouette/refine.h"

namespace limn::silhouette {

/// Vertices that a side has between its corners: the samples of a curve and a silhouette point of either face.
inline constexpr std::size_t kMaxSideVertices = kMaxSegments + 1;

/// Whether a triangle without a segment is cut around its middle, by the numbers of vertices on its sides.
inline bool wantsCentre(const std::array<std::size_t, 3>& counts) {
  return (counts[0] > 0) + (counts[1] > 0) + (counts[2] > 0) > 1;
}

/// A triangle with the vertices on its sides, by number; the corners counter-clockwise.
struct Outline {
  std::array<std::uint32_t, 3> corners{};
  /// On the side from corner k to corner k + 1, in that order.
  std::array<std::array<std::uint32_t, kMaxSideVertices>, 3> sides;
  std::array<std::size_t, 3> counts{};
  /// The middle, used where two or three sides have vertices and there is no segment.
  std::uint32_t centre = kNone;

  /// Vertex `k` of a side: its first corner, the vertices on it, its last corner.
  std::uint32_t onSide(std::size_t side, std::size_t k) const {
    if (k == 0) return corners[side];
    return k > counts[side] ? corners[(side + 1) % 3] : sides[side][k - 1];
  }
};

/// A segment across an outline: from the side that leaves corner `lone` to the side that comes back to it.
struct Cut {
  std::size_t lone = 0;
  /// Where on those two sides it ends: 0 at the side's first corner, counts + 1 at its last, else a vertex.
  std::array<std::size_t, 2> ends{};
  std::span<const std::uint32_t> samples;  ///< the vertices inside, from the first end to the last
};

/// What a triangle becomes.
struct Pieces {
  static constexpr std::size_t kMax = 1 + 3 * kMaxSideVertices + 2 * kMaxSegments;
  std::array<std::array<std::uint32_t, 3>, kMax> triangles;
  std::size_t count = 0;

  /// Leaves out what has a vertex twice: a segment that ends at a corner makes such.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) triangles[count++] = {a, b, c};
  }
};

/// Where vertices are: those of the mesh first, then those of the stream.
struct Places {
  std::span<const glm::vec3> mesh, stream;

  const glm::vec3& operator[](std::uint32_t vertex) const {
    return vertex < mesh.size() ? mesh[vertex] : stream[vertex - mesh.size()];
  }
};

/// The pieces without a segment: 1 + vertices on the sides of them, two more around a centre.
void remesh(const Outline& outline, Pieces& pieces);

/// The pieces on both sides of a segment: 1 + vertices on the sides + 2 · samples of them.
void remesh(const Outline& outline, const Cut& cut, const PixelBound& bound, const Places& places,
            Pieces& pieces);

}  // namespace limn::silhouette
