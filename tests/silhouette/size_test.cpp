// Streams that 32 bits cannot number are refused before memory is taken for them.
#include <gtest/gtest.h>

#include "shapes.h"
#include "silhouette/method.h"

namespace limn::silhouette::test {
namespace {

constexpr std::uint64_t kMost = 0xfffffffe;  // vertices, or indices

void expectRefusal(std::size_t meshVertices, const StreamSize& size) {
  try {
    requireNumbered(meshVertices, size);
    ADD_FAILURE() << meshVertices << " + " << size.vertices << " vertices, " << size.triangles
                  << " triangles";
  } catch (const TooManyTriangles& error) {
    EXPECT_EQ(error.limit, TooManyTriangles::Limit::kIndices);
    EXPECT_EQ(error.triangles, size.triangles);
  }
}

TEST(StreamSize, IsWhat32BitsNumber) {
  requireNumbered(0, {});
  requireNumbered(1000, {kMost - 1000, kMost / 3});
  expectRefusal(1000, {kMost - 999, 0});
  expectRefusal(1000, {0, kMost / 3 + 1});
  // Sums that look small in 32 bits.
  expectRefusal(1000, {std::uint64_t{1} << 32, 5});
  expectRefusal(1000, {5, std::uint64_t{1} << 32});
  expectRefusal(std::size_t{1} << 32, {});
}

// At 64 segments a side each triangle becomes 4,096.
TEST(StreamSize, RefusedRefinementsLeaveTheRefinerOfUse) {
  const Shape shape = torus(440, 420);
  const View view = perspectiveFrom({1, 2, 4});
  Workers workers(2);
  const Topology topology(shape.mesh());
  Refiner refiner(shape.mesh(), topology, workers), untroubled(shape.mesh(), topology, workers);
  for (const Method method : {Method::kPatches, Method::kPn}) {
    Parameters parameters;
    parameters.method = method;
    parameters.segments = kMaxSegments;
    parameters.beta = 1e9f;  // every edge bends
    RefinedStream stream, expected;
    EXPECT_THROW(refiner.refine(view, parameters, stream), TooManyTriangles);
    EXPECT_LT(stream.positions.capacity(), 1000u);

    parameters = {};
    parameters.tolerance = 2e-3f;
    parameters.method = method;
    refiner.refine(view, parameters, stream);
    untroubled.refine(view, parameters, expected);
    EXPECT_TRUE(stream.isConsistent(shape.mesh()));
    EXPECT_GT(stream.triangleCount(), 0u);
    EXPECT_EQ(stream.indices, expected.indices);
    EXPECT_EQ(stream.positions, expected.positions);
  }
}

}  // namespace
}  // namespace limn::silhouette::test
