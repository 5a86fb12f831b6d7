// Whether a curved triangle can do without vertices inside: the triangles that its divided sides span must pass within the
// tolerance of the patch, in the middle, and halfway between the two sides that are joined where there are.
//
// The patch of patch.h is linear in the offsets of its sides, and so is what forBareTriangles() spans. The difference at a
// place is a sum of the six offsets with factors that depend on the pattern, and on the α where a patch is whole from the
// contour on: no patch needs to be set up, and nothing is branched on.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "silhouette/edge_curves.h"
#include "silhouette/pattern.h"

namespace limn::silhouette {

/// A side as the test wants it.
struct BentSide {
  CurveOffsets offsets{};  ///< α d at its start and at its end
  float alpha = 0;
  float inverse = 1;  ///< 1 / α
};

class BareTest {
 public:
  static constexpr std::size_t kPlaces = 2;

  /// Whether there is a test for a pattern without vertices inside.
  static bool has(const Pattern& pattern) {
    const std::uint32_t divided = pattern.dividedSides();
    if (divided == 3) return pattern.sides == std::array<std::uint32_t, 3>{2, 2, 2};
    return divided < 2 || std::max({pattern.sides[0], pattern.sides[1], pattern.sides[2]}) <= kMost;
  }

  /// What the patch adds to what is spanned, at each place, for a pattern that has a test.
  static std::array<glm::vec3, kPlaces> differences(const Pattern& pattern,
                                                    const std::array<BentSide, 3>& sides,
                                                    bool wholeFromContour, const glm::vec3& fittedCenter) {
    const auto& places = kTable[indexOf(pattern)];
    return {offset(places[0], sides, wholeFromContour, fittedCenter),
            offset(places[1], sides, wholeFromContour, fittedCenter)};
  }

  /// What the patch adds at the middles of the spokes from the corners to the midpoint, beyond the spokes' chords.
  static std::array<glm::vec3, 3> beyondSpokes(const std::array<BentSide, 3>& sides, bool wholeFromContour,
                                               const glm::vec3& fittedCenter) {
    const glm::vec3 half = 0.5f * offset(kTable[0][0], sides, wholeFromContour, fittedCenter);
    return {offset(kSpokes[0], sides, wholeFromContour, fittedCenter) - half,
            offset(kSpokes[1], sides, wholeFromContour, fittedCenter) - half,
            offset(kSpokes[2], sides, wholeFromContour, fittedCenter) - half};
  }

  /// The weights of the corners at a place, and at the middle of a spoke.
  static const std::array<float, 3>& weights(const Pattern& pattern, std::size_t place) {
    return kTable[indexOf(pattern)][place].weights;
  }
  static const std::array<float, 3>& spokeWeights(std::size_t corner) { return kSpokes[corner].weights; }

 private:
  // Of α d at the side's start and end: in the patch with blend 1, and in what is spanned.
  struct Side {
    float own[2] = {0, 0}, spanned[2] = {0, 0};
    float blend = 1;  // the largest 1 / (1 - opposite weight)
  };
  struct Place {
    std::array<float, 3> weights{};
    float product = 0;  // of the weights
    std::array<Side, 3> sides{};
  };
  static constexpr std::uint32_t kMost = BareTriangles::kMaxSegments;
  using Table = std::array<std::array<Place, kPlaces>, BareTriangles::kPatterns>;

  // In a fan, four segments stand for more: the middle of the side is a vertex or nearly so.
  static std::size_t indexOf(const Pattern& pattern) {
    return BareTriangles::indexOf({std::min(pattern.sides[0], kMost), std::min(pattern.sides[1], kMost),
                                   std::min(pattern.sides[2], kMost)});
  }

  // What the patch adds at a place, less what is spanned there.
  static glm::vec3 offset(const Place& place, const std::array<BentSide, 3>& sides, bool wholeFromContour,
                          const glm::vec3& fittedCenter) {
    glm::vec3 sum(0.0f);
    float blends = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const Side& share = place.sides[k];
      const float blend = wholeFromContour ? std::min(share.blend, sides[k].inverse) : 1.0f;
      blends += blend * sides[k].alpha;
      sum += (blend * share.own[0] - share.spanned[0]) * sides[k].offsets[0] +
             (blend * share.own[1] - share.spanned[1]) * sides[k].offsets[1];
    }
    return sum + (2.0f * blends * place.product) * fittedCenter;
  }
  static constexpr Place placeAt(std::array<float, 3> weights) {
    Place place{weights, weights[0] * weights[1] * weights[2], {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const float from = weights[k], to = weights[(k + 1) % 3], opposite = weights[(k + 2) % 3];
      Side& side = place.sides[k];
      side.blend = 1.0f / (1.0f - opposite);
      side.own[0] = 3.0f * from * to * (from + 0.5f * opposite);
      side.own[1] = 3.0f * from * to * (to + 0.5f * opposite);
    }
    return place;
  }
  // The weights of the corners at a vertex of BareTriangles.
  static constexpr std::array<float, 3> weightsOf(const Pattern& pattern, std::size_t vertex) {
    const std::size_t k = vertex / 4;
    const float t = static_cast<float>(vertex % 4) / static_cast<float>(pattern.sides[k]);
    std::array<float, 3> weights{};
    weights[k] = 1.0f - t;
    weights[(k + 1) % 3] = t;
    return weights;
  }
  // Twice the area of a triangle of weights.
  static constexpr float areaOf(const std::array<float, 3>& a, const std::array<float, 3>& b,
                                const std::array<float, 3>& c) {
    return (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]);
  }
  // Adds the vertex's share of what is spanned: it is on the curve of its side.
  static constexpr void span(Place& place, const Pattern& pattern, std::size_t vertex, float share) {
    const float t = weightsOf(pattern, vertex)[(vertex / 4 + 1) % 3], s = 1.0f - t;
    place.sides[vertex / 4].spanned[0] += share * (3.0f * s * t * s);
    place.sides[vertex / 4].spanned[1] += share * (3.0f * s * t * t);
  }
  // What the triangle spans in which the place lies.
  static constexpr void spanAll(Place& place, const Pattern& pattern) {
    const BareTriangles& list = BareTriangles::of(pattern);
    for (std::uint32_t i = 0; i < list.count; ++i) {
      const std::array<std::uint8_t, 3>& v = list.corners[i];
      const std::array<float, 3> a = weightsOf(pattern, v[0]), b = weightsOf(pattern, v[1]),
                                 c = weightsOf(pattern, v[2]);
      const float area = areaOf(a, b, c);
      const std::array<float, 3> shares{areaOf(place.weights, b, c) / area,
                                        areaOf(a, place.weights, c) / area,
                                        areaOf(a, b, place.weights) / area};
      if (std::min({shares[0], shares[1], shares[2]}) < -1e-5f) continue;
      for (std::size_t k = 0; k < 3; ++k) span(place, pattern, v[k], shares[k]);
      return;
    }
  }
  static constexpr Table makeTable() {
    constexpr float kThird = 1.0f / 3.0f;
    Table table{};
    for (std::uint32_t a = 1; a <= kMost; ++a)
      for (std::uint32_t b = 1; b <= kMost; ++b)
        for (std::uint32_t c = 1; c <= kMost; ++c) {
          const Pattern pattern{{a, b, c}, 2};
          const std::uint32_t divided = pattern.dividedSides(), k = pattern.firstDivided();
          Place middle = placeAt({kThird, kThird, kThird});
          spanAll(middle, pattern);
          Place halfway = middle;
          if (divided == 1 || divided == 2) {
            // A ladder's apex is the end of side k, a fan's the corner opposite to it.
            std::array<float, 3> weights{0.25f, 0.25f, 0.25f};
            weights[(k + 3 - divided) % 3] = 0.5f;
            halfway = placeAt(weights);
            spanAll(halfway, pattern);
          }
          table[BareTriangles::indexOf(pattern.sides)] = {middle, halfway};
        }
    return table;
  }
  static constexpr std::array<Place, 3> makeSpokes() {
    constexpr float kThird = 1.0f / 3.0f;
    return {placeAt({2.0f * kThird, 0.5f * kThird, 0.5f * kThird}),
            placeAt({0.5f * kThird, 2.0f * kThird, 0.5f * kThird}),
            placeAt({0.5f * kThird, 0.5f * kThird, 2.0f * kThird})};
  }
  static const Table kTable;
  static const std::array<Place, 3> kSpokes;
};

inline constexpr BareTest::Table BareTest::kTable = BareTest::makeTable();
inline constexpr std::array<BareTest::Place, 3> BareTest::kSpokes = BareTest::makeSpokes();

}  // namespace limn::silhouette
