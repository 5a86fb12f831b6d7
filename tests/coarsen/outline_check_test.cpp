#include "apps/coarsen/outline_check.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "apps/coarsen/coarsen.h"
#include "tests/coarsen/fine_models.h"

namespace limn::coarsen::test {
namespace {

TEST(OutlinePromise, DirectionsAreUnitAndSpread) {
  for (const std::uint64_t seed : {0, 5}) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& direction : viewDirections(500, seed)) {
      EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
      sum += direction;
    }
    EXPECT_LT(glm::length(sum) / 500.0, 0.1) << seed;
  }
}

TEST(OutlinePromise, IsKeptByTheModelItself) {
  const scene::Mesh mesh = builtinMesh("icosphere:4");
  Workers workers(2);
  EXPECT_EQ(brokenViews(mesh, mesh, {0.5, 160, 120}, viewDirections(20), workers), 0);
}

TEST(OutlinePromise, KnowsHowFarAPolygonIsFromItsDisc) {
  // The flat method would be needed to see corners: normals along the triangles keep the patches flat.
  scene::Mesh flat = builtinMesh("icosphere:1");
  const scene::Mesh fine = builtinMesh("icosphere:5");
  std::vector<glm::vec3> positions, normals;
  for (std::size_t side = 0; side < flat.indices.size(); ++side) {
    const std::size_t first = side - side % 3;
    const auto at = [&](std::size_t k) { return flat.positions[flat.indices[first + k]]; };
    positions.push_back(at(side % 3));
    normals.push_back(glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))));
  }
  flat.positions = positions;
  flat.normals = normals;
  for (std::size_t side = 0; side < flat.indices.size(); ++side)
    flat.indices[side] = static_cast<std::uint32_t>(side);
  Workers workers(2);
  const std::vector<glm::dvec3> views = viewDirections(20);
  // Edges of 31 and 36 degrees: their middles are up to 4.9 % of the radius inside, about 9 of 190 pixels.
  EXPECT_EQ(brokenViews(fine, flat, {15.0, 500, 400}, views, workers), 0);
  EXPECT_EQ(brokenViews(fine, flat, {2.0, 500, 400}, views, workers), 20);
}

TEST(OutlinePromise, FoundModelKeepsItFromElsewhere) {
  const scene::Mesh fine = builtinMesh("icosphere:3");
  const OutlinePromise promise{1.0, 80, 60};
  Workers workers(2);
  const std::optional<scene::Mesh> small = coarsenWithin(fine, promise, workers);
  ASSERT_TRUE(small.has_value());
  EXPECT_LT(small->indices.size(), fine.indices.size() / 4);
  EXPECT_EQ(brokenViews(fine, *small, promise, viewDirections(100, 4711), workers), 0);
}

}  // namespace
}  // namespace limn::coarsen::test
