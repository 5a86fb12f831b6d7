// Whether a curved triangle can do without vertices inside: what its divided sides span must pass within the tolerance of
// the patch, in the middle, and halfway between the two sides that are joined where there are.
//
// The patch of patch.h is linear in the offsets of its sides, and so is what forBareTriangles() spans. The difference at a
// place is a sum of the six offsets with factors that depend on which sides are divided, and on the α where a patch is
// whole from the contour on: no patch needs to be set up, and nothing is branched on.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "silhouette/edge_curves.h"

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

  /// What the patch adds to what is spanned, at each place. `divided` has bit k where side k is divided; with all three
  /// divided, each must have two segments.
  static std::array<glm::vec3, kPlaces> differences(std::uint32_t divided,
                                                    const std::array<BentSide, 3>& sides,
                                                    bool wholeFromContour, const glm::vec3& fittedCenter) {
    return {offset(kTable[divided][0], sides, wholeFromContour, fittedCenter),
            offset(kTable[divided][1], sides, wholeFromContour, fittedCenter)};
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
  static const std::array<float, 3>& weights(std::uint32_t divided, std::size_t place) {
    return kTable[divided][place].weights;
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
  using Table = std::array<std::array<Place, kPlaces>, 8>;

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
  // Adds the curve of side k at t, times `factor`, to what is spanned.
  static constexpr void span(Place& place, std::size_t k, float t, float factor) {
    const float s = 1.0f - t;
    place.sides[k % 3].spanned[0] += factor * (3.0f * s * t * s);
    place.sides[k % 3].spanned[1] += factor * (3.0f * s * t * t);
  }
  static constexpr Table makeTable() {
    constexpr float kThird = 1.0f / 3.0f;
    Table table{};
    for (std::size_t divided = 0; divided < 8; ++divided) {
      const std::size_t count = (divided & 1) + (divided >> 1 & 1) + (divided >> 2 & 1);
      Place middle = placeAt({kThird, kThird, kThird}), halfway = middle;
      // The divided side after a whole one, as Pattern::firstDivided().
      std::size_t k = 0;
      while (count > 0 && count < 3 && ((divided >> k & 1) == 0 || (divided >> (k + 2) % 3 & 1) != 0)) ++k;
      if (count == 1 || count == 2) {
        // A ladder's apex is the end of side k, a fan's the corner opposite to it.
        std::array<float, 3> weights{0.25f, 0.25f, 0.25f};
        weights[(k + 3 - count) % 3] = 0.5f;
        halfway = placeAt(weights);
        for (std::size_t side = 0; side < count; ++side) span(halfway, k + side, 0.5f, 0.5f);
      }
      if (count == 1) span(middle, k, 0.5f, 2.0f * kThird);
      if (count == 2) {
        span(middle, k, kThird, 0.5f);
        span(middle, k + 1, 2.0f * kThird, 0.5f);
      }
      if (count == 3) {
        for (std::size_t side = 0; side < 3; ++side) span(middle, side, 0.5f, kThird);
        halfway = middle;
      }
      table[divided] = {middle, halfway};
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
