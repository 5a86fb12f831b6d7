// What the test of bare triangles finds apart is what patch and spanned curves are apart.
#include "silhouette/bare_test.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "silhouette/patch.h"
#include "silhouette/pattern.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

// What is spanned at the places of the test, as its file says.
std::array<vec3, BareTest::kPlaces> spanned(const Patch& patch, const Pattern& pattern) {
  const std::uint32_t k = pattern.firstDivided();
  const auto onSide = [&](std::uint32_t side, float t) {
    return patch.alphas[side % 3] * curveOffset(patch.sides[side % 3], t);
  };
  constexpr float kThird = 1.0f / 3.0f;
  switch (pattern.dividedSides()) {
    case 0:
      return {vec3(0.0f), vec3(0.0f)};
    case 1:
      return {2.0f * kThird * onSide(k, 0.5f), 0.5f * onSide(k, 0.5f)};
    case 2:
      return {0.5f * (onSide(k, kThird) + onSide(k + 1, 2.0f * kThird)),
              0.5f * (onSide(k, 0.5f) + onSide(k + 1, 0.5f))};
    default:
      const vec3 middle = kThird * (onSide(0, 0.5f) + onSide(1, 0.5f) + onSide(2, 0.5f));
      return {middle, middle};
  }
}

TEST(BareTest, FindsWhatPatchAndSpannedCurvesAreApart) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  const auto vector = [&] { return vec3(any(engine), any(engine), any(engine)); };
  for (int round = 0; round < 400; ++round) {
    Patch patch;
    patch.wholeFromContour = round % 2 == 0;
    patch.fittedCenter = round % 3 == 0 ? vec3(0.0f) : vector();
    Pattern pattern;
    std::array<BentSide, 3> sides{};
    std::uint32_t divided = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      patch.corners[k] = vector();
      pattern.sides[k] = 1 + engine() % 2;
      divided |= pattern.sides[k] > 1 ? 1u << k : 0u;
      if (pattern.sides[k] == 1 && engine() % 2 == 0) {  // does not bend at all
        patch.alphas[k] = 0.0f;
        continue;
      }
      patch.alphas[k] = 0.5f * (1.001f + any(engine));
      patch.sides[k] = {vector(), vector()};
      const float alpha = patch.alphas[k];
      sides[k] = {{alpha * patch.sides[k][0], alpha * patch.sides[k][1]}, alpha, 1.0f / alpha};
    }
    const std::array<vec3, BareTest::kPlaces> expected = spanned(patch, pattern);
    const std::array<vec3, BareTest::kPlaces> apart =
        BareTest::differences(divided, sides, patch.wholeFromContour, patch.fittedCenter);
    for (std::size_t place = 0; place < BareTest::kPlaces; ++place) {
      const std::array<float, 3>& w = BareTest::weights(divided, place);
      EXPECT_NEAR(w[0] + w[1] + w[2], 1.0f, 1e-6f);
      EXPECT_LT(glm::length(patch.offset(w[0], w[1], w[2]) - expected[place] - apart[place]), 2e-6f)
          << "round " << round << ", place " << place << ", divided " << divided;
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
}

}  // namespace
}  // namespace limn::silhouette::test
