// How a curved triangle is cut: a fan around its parametric midpoint, whose three sub-patches may be divided
// into rows. Depends on counts only, never on positions.
//
//            2              Side k runs from corner k to corner k + 1. The sub-patch over it has rows
//            parallel to it:
//           /|\             row 0 is the side itself with its own segments, row m the midpoint. Spokes run
//           from the
//          / | \            corners to the midpoint and have m segments each.
//         /  M  \           With m = 1 this is the plain fan of the paper.
//        / /   \ \          .
//       0---------1
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace limn::silhouette {

struct Pattern {
  std::array<std::uint32_t, 3> sides{1, 1, 1};  ///< segments of each side, >= 1
  std::uint32_t rows = 1;                       ///< m >= 1
  float density = 0;                            ///< segments that a row of a whole side's length needs inside

  /// Segments of row r, 0 <= r < rows, of the sub-patch over side k.
  std::uint32_t rowSegments(std::uint32_t k, std::uint32_t r) const {
    if (r == 0) return sides[k];
    // A side's curve shrunk to 1 - s has chord errors 1 - s times as large: √(1 - s) of its segments keep
    // them.
    const float rest = 1.0f - static_cast<float>(r) / static_cast<float>(rows);
    const float wanted = std::ceil(std::fmax(static_cast<float>(sides[k]) * std::sqrt(rest), density * rest));
    return wanted > 1.0f ? static_cast<std::uint32_t>(wanted) : 1u;
  }

  /// Vertices inside the triangle: the midpoint, then the spokes of corners 0, 1, 2 from the outside in, then
  /// the inner points of the rows of sub-patches 0, 1, 2.
  std::uint32_t vertexCount() const {
    std::uint32_t count = 1 + 3 * (rows - 1);
    for (std::uint32_t k = 0; k < 3; ++k)
      for (std::uint32_t r = 1; r < rows; ++r) count += rowSegments(k, r) - 1;
    return count;
  }

  std::uint32_t triangleCount() const {
    std::uint32_t count = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      count += rowSegments(k, 0);
      for (std::uint32_t r = 1; r < rows; ++r) count += 2 * rowSegments(k, r);
    }
    return count;
  }
};

/// Calls visit(k, s, t) for the inner vertices in the order of vertexCount(): the point of sub-patch k at the
/// share s of the way to the midpoint and at t along the side.
template <class Visit>
void forVertices(const Pattern& pattern, const Visit& visit) {
  const auto m = static_cast<float>(pattern.rows);
  visit(0u, 1.0f, 0.0f);
  for (std::uint32_t k = 0; k < 3; ++k)
    for (std::uint32_t r = 1; r < pattern.rows; ++r) visit(k, static_cast<float>(r) / m, 0.0f);
  for (std::uint32_t k = 0; k < 3; ++k) {
    for (std::uint32_t r = 1; r < pattern.rows; ++r) {
      const std::uint32_t n = pattern.rowSegments(k, r);
      for (std::uint32_t i = 1; i < n; ++i)
        visit(k, static_cast<float>(r) / m, static_cast<float>(i) / static_cast<float>(n));
    }
  }
}

/// Calls emit(a, b, c) for the triangles, counter-clockwise like the whole. `sidePoint(k, i)` names point i =
/// 0 … sides[k] of side k, `inner(i)` the inner vertex i.
template <class SidePoint, class Inner, class Emit>
void forTriangles(const Pattern& pattern, const SidePoint& sidePoint, const Inner& inner, const Emit& emit) {
  const std::uint32_t m = pattern.rows;
  std::uint32_t firstOfRow = 1 + 3 * (m - 1);
  const auto spoke = [&](std::uint32_t corner, std::uint32_t r) {
    return inner(1 + corner * (m - 1) + r - 1);
  };
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t next = k == 2 ? 0 : k + 1;
    std::uint32_t before = 0;  // first inner point of the row below
    for (std::uint32_t r = 0; r < m; ++r) {
      const auto point = [&](std::uint32_t row, std::uint32_t first, std::uint32_t n, std::uint32_t i) {
        if (row == m) return inner(0);
        if (row == 0) return sidePoint(k, i);
        if (i == 0) return spoke(k, row);
        return i == n ? spoke(next, row) : inner(first + i - 1);
      };
      const std::uint32_t low = pattern.rowSegments(k, r),
                          high = r + 1 < m ? pattern.rowSegments(k, r + 1) : 0;
      const auto below = [&](std::uint32_t i) { return point(r, before, low, i); };
      const auto above = [&](std::uint32_t i) { return point(r + 1, firstOfRow, high, i); };
      // Zip the two rows: step on the one whose next point comes first.
      for (std::uint32_t i = 0, j = 0; i < low || j < high;) {
        if (j == high || (i < low && (i + 1) * high <= (j + 1) * low)) {
          emit(below(i), below(i + 1), above(j));
          ++i;
        } else {
          emit(below(i), above(j + 1), above(j));
          ++j;
        }
      }
      before = firstOfRow;
      if (r + 1 < m) firstOfRow += high - 1;
    }
  }
}

}  // namespace limn::silhouette
