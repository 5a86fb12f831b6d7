// Patterns tile the triangle, whatever the counts of its sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
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

TEST(Pattern, BareTrianglesAreListedAsTheyAreFound) {
  for (std::uint32_t a = 1; a <= 5; ++a)
    for (std::uint32_t b = 1; b <= 5; ++b)
      for (std::uint32_t c = 1; c <= 5; ++c) {
        const Pattern pattern{{a, b, c}, 2};
        const std::uint32_t most = std::max({a, b, c});
        if (most == 1 || (most > 2 && pattern.dividedSides() == 3)) continue;
        ASSERT_EQ(BareTriangles::has(pattern), most <= BareTriangles::kMaxSegments);
        EXPECT_FALSE(BareTriangles::has({{a, b, c}, 3}));
        if (most > BareTriangles::kMaxSegments) continue;
        using Corners = std::array<glm::dvec2, 3>;
        std::vector<Corners> found, listed;
        forBareTriangles(
            pattern, [&](std::uint32_t k, std::uint32_t i) { return onSide(pattern, k, i); },
            [&](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) {
              found.push_back({p, q, r});
            });
        const BareTriangles& list = BareTriangles::of(pattern);
        for (std::uint32_t t = 0; t < list.count; ++t) {
          const auto point = [&](std::size_t k) {
            return onSide(pattern, list.corners[t][k] / 4u, list.corners[t][k] % 4u);
          };
          listed.push_back({point(0), point(1), point(2)});
        }
        ASSERT_EQ(listed.size(), pattern.triangleCount());
        for (std::size_t t = 0; t < found.size(); ++t)
          for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(glm::length(found[t][k] - listed[t][k]), 1e-12);
      }
}

}  // namespace
}  // namespace limn::silhouette::test
