// How a curved triangle is cut. Depends on counts only, never on positions.
//
//            2              Side k runs from corner k to corner k + 1 and has segments of its own, which its other
//           / \             triangle shares. The inside has the points of a barycentric grid of N steps, those of its
//          /   \            border left out: none for N <= 2, where divided sides are joined by the fewest triangles;
//         / .   \           the midpoint for N = 3, which makes the fan of the paper; N - 3 steps a side for more. A strip
//        / . .   \          joins them to each side. With N segments on every side that makes N² triangles.
//       0---------1
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace limn::silhouette {

struct Pattern {
  std::array<std::uint32_t, 3> sides{1, 1, 1};  ///< segments of each side, >= 1
  std::uint32_t steps = 1;                      ///< N of the grid, >= 1

  /// Steps along a side of the grid's inside; for steps >= 3.
  constexpr std::uint32_t innerSteps() const { return steps - 3; }
  /// Vertices inside the triangle.
  constexpr std::uint32_t vertexCount() const { return steps < 3 ? 0 : (steps - 1) * (steps - 2) / 2; }
  constexpr std::uint32_t triangleCount() const {
    const std::uint32_t border = sides[0] + sides[1] + sides[2];
    return steps < 3 ? border - 2 : border + 3 * innerSteps() + innerSteps() * innerSteps();
  }

  constexpr std::uint32_t dividedSides() const {
    return (sides[0] > 1 ? 1u : 0u) + (sides[1] > 1 ? 1u : 0u) + (sides[2] > 1 ? 1u : 0u);
  }
  /// The first of the divided sides: the one after a whole one, or 0.
  constexpr std::uint32_t firstDivided() const {
    for (std::uint32_t k = 0; k < 3; ++k)
      if (sides[k] > 1 && sides[k == 0 ? 2 : k - 1] == 1) return k;
    return 0;
  }
};

/// Calls visit(v, w) with the weights of corners 1 and 2 for the vertices inside, rows parallel to side 0.
template <class Visit>
void forVertices(const Pattern& pattern, const Visit& visit) {
  if (pattern.steps < 3) return;
  const auto steps = static_cast<float>(pattern.steps);
  for (std::uint32_t r = 1; r + 1 < pattern.steps; ++r)
    for (std::uint32_t i = 1; i + r < pattern.steps; ++i)
      visit(static_cast<float>(i) / steps, static_cast<float>(r) / steps);
}

/// The triangles of a pattern without vertices inside: a ladder between two divided sides, a fan over one; for three halved
/// sides all corners are cut off.
template <class SidePoint, class Emit>
constexpr void forBareTriangles(const Pattern& pattern, const SidePoint& sidePoint, const Emit& emit) {
  const std::uint32_t k = pattern.firstDivided(), next = (k + 1) % 3, last = (k + 2) % 3;
  if (pattern.dividedSides() == 3) {
    const auto first = sidePoint(0, 1), second = sidePoint(1, 1), third = sidePoint(2, 1);
    emit(first, sidePoint(1, 0), second);
    emit(sidePoint(0, 0), first, third);
    emit(third, second, sidePoint(2, 0));
    emit(first, second, third);
    return;
  }
  // Up the two sides from the corner between them, always along the shorter of the next steps; of two that end at the same
  // height first along the coarser side, so that the last line across starts at a vertex of the finer one.
  const std::uint32_t m = pattern.sides[k], n = pattern.sides[next];
  const auto left = [&](std::uint32_t i) { return sidePoint(k, m - i); };
  const auto right = [&](std::uint32_t j) { return j == n ? sidePoint(last, 0) : sidePoint(next, j); };
  emit(left(1), left(0), right(1));
  for (std::uint32_t i = 1, j = 1; i < m || j < n;) {
    const std::uint32_t leftHeight = (i + 1) * n, rightHeight = (j + 1) * m;
    if (j == n || (i < m && (leftHeight < rightHeight || (leftHeight == rightHeight && m <= n)))) {
      emit(left(i + 1), left(i), right(j));
      ++i;
    } else {
      emit(left(i), right(j), right(j + 1));
      ++j;
    }
  }
}

/// The triangles of forBareTriangles() where no side has more than kMaxSegments segments, listed once: point i of side k is
/// 4 k + i.
struct BareTriangles {
  static constexpr std::uint32_t kMaxSegments = 4;

  std::uint32_t count = 0;
  std::array<std::array<std::uint8_t, 3>, 8> corners{};

  static bool has(const Pattern& pattern) {
    return pattern.steps < 3 &&
           std::max({pattern.sides[0], pattern.sides[1], pattern.sides[2]}) <= kMaxSegments;
  }
  static constexpr const BareTriangles& of(const Pattern& pattern) { return kTable[indexOf(pattern.sides)]; }

  static constexpr std::size_t kPatterns = 64;
  /// Below kPatterns, for sides of 1 … kMaxSegments segments.
  static constexpr std::size_t indexOf(const std::array<std::uint32_t, 3>& sides) {
    return 16 * std::size_t{sides[0] - 1} + 4 * std::size_t{sides[1] - 1} + sides[2] - 1;
  }

 private:
  using Table = std::array<BareTriangles, kPatterns>;

  static constexpr Table makeTable();
  static const Table kTable;
};

constexpr BareTriangles::Table BareTriangles::makeTable() {
  Table table{};
  for (std::uint32_t a = 1; a <= kMaxSegments; ++a)
    for (std::uint32_t b = 1; b <= kMaxSegments; ++b)
      for (std::uint32_t c = 1; c <= kMaxSegments; ++c) {
        const Pattern pattern{{a, b, c}, 2};
        const bool halved = a == 2 && b == 2 && c == 2;
        if (pattern.dividedSides() == 0 || (pattern.dividedSides() == 3 && !halved)) continue;
        BareTriangles& list = table[indexOf(pattern.sides)];
        const auto sidePoint = [&](std::uint32_t k, std::uint32_t i) {
          return static_cast<std::uint8_t>(i == pattern.sides[k] ? (k + 1) % 3 * 4 : 4 * k + i);
        };
        forBareTriangles(pattern, sidePoint, [&](std::uint8_t p, std::uint8_t q, std::uint8_t r) {
          list.corners[list.count++] = {p, q, r};
        });
      }
  return table;
}
inline constexpr BareTriangles::Table BareTriangles::kTable = BareTriangles::makeTable();

/// Calls emit(a, b, c) for the triangles, counter-clockwise like the whole. `sidePoint(k, i)` names point i = 0 …
/// sides[k] of side k, `inner(i)` vertex i of forVertices.
template <class SidePoint, class Inner, class Emit>
void forTriangles(const Pattern& pattern, const SidePoint& sidePoint, const Inner& inner, const Emit& emit) {
  if (pattern.steps < 3) return forBareTriangles(pattern, sidePoint, emit);
  const std::uint32_t m = pattern.innerSteps();
  const auto point = [&](std::uint32_t r, std::uint32_t i) {
    return inner(r * (m + 1) - r * (r - 1) / 2 + i);
  };
  for (std::uint32_t r = 0; r < m; ++r) {
    for (std::uint32_t i = 0; i + r < m; ++i) {
      emit(point(r, i), point(r, i + 1), point(r + 1, i));
      if (i + r + 1 < m) emit(point(r, i + 1), point(r + 1, i + 1), point(r + 1, i));
    }
  }
  const auto inside = [&](std::uint32_t k, std::uint32_t j) {
    return k == 0 ? point(0, j) : k == 1 ? point(j, m - j) : point(m - j, 0);
  };
  // Only where the cut passes before the inside's corner point, (1/N, 1/N) along the two sides.
  const auto isCut = [&](std::uint32_t corner) {
    const std::uint32_t after = pattern.sides[corner], before = pattern.sides[(corner + 2) % 3];
    return after > 1 && before > 1 && after + before > pattern.steps;
  };
  for (std::uint32_t k = 0; k < 3; ++k) {
    // Between two divided sides the corner is cut off: the line from it to the inside would be the longest of all.
    if (isCut(k)) {
      const std::uint32_t last = (k + 2) % 3;
      const auto after = sidePoint(k, 1), before = sidePoint(last, pattern.sides[last] - 1);
      emit(sidePoint(k, 0), after, before);
      emit(after, inside(k, 0), before);
    }
    // Along the side, point i of it is at i/n and point j of the inside at (j + 3/2)/N: take the shorter diagonal.
    const auto n = static_cast<std::int64_t>(pattern.sides[k]), N = static_cast<std::int64_t>(pattern.steps);
    const std::uint32_t end = pattern.sides[k] - (isCut((k + 1) % 3) ? 1 : 0);
    for (std::uint32_t i = isCut(k) ? 1 : 0, j = 0; i < end || j < m;) {
      const std::int64_t outer = std::llabs(2 * (i + 1) * N - (2 * j + 3) * n);
      const std::int64_t other = std::llabs((2 * j + 5) * n - 2 * i * N);
      if (j == m || (i < end && outer <= other)) {
        emit(sidePoint(k, i), sidePoint(k, i + 1), inside(k, j));
        ++i;
      } else {
        emit(sidePoint(k, i), inside(k, j + 1), inside(k, j));
        ++j;
      }
    }
  }
}

}  // namespace limn::silhouette
