// Patterns tile the triangle, whatever the counts of its sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/vec2.hpp>
#include <vector>

#include "silhouette/pattern.h"

namespace limn::silhouette::test {
namespace {

// Point i of side k, in weights of corners 1 and 2.
glm::dvec2 onSide(const Pattern& pattern, std::uint32_t k, std::uint32_t i) {
  const glm::dvec2 corners[3] = {{0, 0}, {1, 0}, {0, 1}};
  const double t = static_cast<double>(i) / pattern.sides[k];
  return (1.0 - t) * corners[k] + t * corners[(k + 1) % 3];
}

void expectTiled(const Pattern& pattern) {
  SCOPED_TRACE(testing::Message() << pattern.sides[0] << ' ' << pattern.sides[1] << ' ' << pattern.sides[2]
                                  << ", steps " << pattern.steps);
  std::vector<glm::dvec2> inside;
  forVertices(pattern, [&](float v, float w) { inside.emplace_back(v, w); });
  EXPECT_EQ(inside.size(), pattern.vertexCount());
  std::uint32_t count = 0;
  double area = 0.0, least = 1.0;
  forTriangles(
      pattern, [&](std::uint32_t k, std::uint32_t i) { return onSide(pattern, k, i); },
      [&](std::uint32_t i) { return inside[i]; },
      [&](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
        const double own = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        ++count;
        area += own;
        least = std::min(least, own);
      });
  EXPECT_EQ(count, pattern.triangleCount());
  EXPECT_GT(least, 1e-6);  // none turns over
  EXPECT_NEAR(area, 1.0, 1e-6);
}

TEST(Pattern, TilesTheTriangle) {
  for (std::uint32_t a = 1; a <= 7; ++a)
    for (std::uint32_t b = 1; b <= 7; ++b)
      for (std::uint32_t c = 1; c <= 7; ++c) {
        const std::uint32_t most = std::max({a, b, c});
        if (most == 1) continue;
        Pattern pattern{{a, b, c}, 2};
        if (most <= 2 || pattern.dividedSides() < 3) expectTiled(pattern);
        for (pattern.steps = 3; pattern.steps <= 8; ++pattern.steps) expectTiled(pattern);
      }
}

}  // namespace
}  // namespace limn::silhouette::test
