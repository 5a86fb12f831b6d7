// What the test of bare triangles finds apart is what patch and spanned curves are apart.
#include "silhouette/bare_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "silhouette/patch.h"
#include "silhouette/pattern.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

// A vertex of a pattern without vertices inside: the weights of the corners there, and what the curve of its side adds.
struct Spanned {
  vec3 weights{0.0f}, offset{0.0f};
};

// What the triangles of the pattern add to the flat one at a place: in the one that goes around it, or beside it.
vec3 spanned(const Patch& patch, const Pattern& pattern, const vec3& place) {
  if (pattern.dividedSides() == 0) return vec3(0.0f);
  const auto sidePoint = [&](std::uint32_t k, std::uint32_t i) {
    const float t = static_cast<float>(i) / static_cast<float>(pattern.sides[k]);
    Spanned point;
    point.weights[static_cast<int>(k)] = 1.0f - t;
    point.weights[static_cast<int>((k + 1) % 3)] = t;
    point.offset = patch.alphas[k] * curveOffset(patch.sides[k], t);
    return point;
  };
  vec3 result(0.0f);
  float best = -1.0f;  // the least share of the triangle's corners
  forBareTriangles(pattern, sidePoint, [&](const Spanned& a, const Spanned& b, const Spanned& c) {
    const vec3 shares = glm::inverse(glm::mat3(a.weights, b.weights, c.weights)) * place;
    const float least = std::min({shares.x, shares.y, shares.z});
    if (least < best) return;
    best = least;
    result = shares.x * a.offset + shares.y * b.offset + shares.z * c.offset;
  });
  EXPECT_GT(best, -1e-5f);
  return result;
}

TEST(BareTest, FindsWhatPatchAndSpannedCurvesAreApart) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  const auto vector = [&] { return vec3(any(engine), any(engine), any(engine)); };
  std::size_t tested = 0;
  for (int round = 0; round < 1200; ++round) {
    Patch patch;
    patch.wholeFromContour = round % 2 == 0;
    patch.fittedCenter = round % 3 == 0 ? vec3(0.0f) : vector();
    Pattern pattern;
    std::array<BentSide, 3> sides{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      patch.corners[k] = vector();
      pattern.sides[k] = 1 + static_cast<std::uint32_t>(engine() % (round % 4 == 0 ? 2 : 4));
      if (pattern.sides[k] == 1 && engine() % 2 == 0) {  // does not bend at all
        patch.alphas[k] = 0.0f;
        continue;
      }
      patch.alphas[k] = 0.5f * (1.001f + any(engine));
      patch.sides[k] = {vector(), vector()};
      const float alpha = patch.alphas[k];
      sides[k] = {{alpha * patch.sides[k][0], alpha * patch.sides[k][1]}, alpha, 1.0f / alpha};
    }
    const bool isTested =
        pattern.dividedSides() < 3 || pattern.sides == std::array<std::uint32_t, 3>{2, 2, 2};
    ASSERT_EQ(BareTest::has(pattern), isTested);
    for (std::size_t place = 0; place < BareTest::kPlaces && isTested; ++place) {
      const vec3 apart =
          BareTest::differences(pattern, sides, patch.wholeFromContour, patch.fittedCenter)[place];
      const std::array<float, 3>& w = BareTest::weights(pattern, place);
      EXPECT_NEAR(w[0] + w[1] + w[2], 1.0f, 1e-6f);
      const vec3 expected = spanned(patch, pattern, {w[0], w[1], w[2]});
      EXPECT_LT(glm::length(patch.offset(w[0], w[1], w[2]) - expected - apart), 3e-6f)
          << "round " << round << ", place " << place;
      ++tested;
    }
    const std::array<vec3, 3> beyond =
        BareTest::beyondSpokes(sides, patch.wholeFromContour, patch.fittedCenter);
    const vec3 middle = patch.point(1.0f / 3.0f, 1.0f / 3.0f, 1.0f / 3.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<float, 3>& w = BareTest::spokeWeights(k);
      const vec3 onChord = 0.5f * (patch.corners[k] + middle);
      EXPECT_LT(glm::length(patch.point(w[0], w[1], w[2]) - onChord - beyond[k]), 3e-6f) << "round " << round;
    }
  }
  EXPECT_GT(tested, 1000u);
}

// Ladders of many segments, whose lines across are not listed, have no test.
TEST(BareTest, KnowsWhichPatternsItTests) {
  EXPECT_TRUE(BareTest::has({{1, 1, 1}, 2}));
  EXPECT_TRUE(BareTest::has({{1, 64, 1}, 2}));
  EXPECT_TRUE(BareTest::has({{4, 1, 4}, 2}));
  EXPECT_FALSE(BareTest::has({{2, 5, 1}, 2}));
  EXPECT_TRUE(BareTest::has({{2, 2, 2}, 2}));
  EXPECT_FALSE(BareTest::has({{2, 2, 3}, 2}));
}

}  // namespace
}  // namespace limn::silhouette::test
