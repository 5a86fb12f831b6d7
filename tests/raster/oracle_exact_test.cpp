// The exact rasterizer on cases that can be checked by hand: a judge should be judged.
#include "tests/raster/oracle_exact.h"

#include <gtest/gtest.h>

namespace limn::test {
namespace {

// A square of 4×4 pixels between pixel centres, cut along its diagonal; counter-clockwise on the screen.
constexpr GridPoint kTopLeft{128, 128}, kTopRight{128 + 1024, 128};
constexpr GridPoint kBottomLeft{128, 128 + 1024}, kBottomRight{128 + 1024, 128 + 1024};
constexpr GridTriangle kLower{{kTopLeft, kBottomLeft, kBottomRight}, 1};
constexpr GridTriangle kUpper{{kTopLeft, kBottomRight, kTopRight}, 1};

constexpr GridPoint centre(int column, int row) {
  return {column * 256 + 128, row * 256 + 128};
}

TEST(OracleExact, TopLeftRule) {
  for (int row = 0; row <= 5; ++row) {
    for (int column = 0; column <= 5; ++column) {
      const int times = covers(kLower, centre(column, row)) + covers(kUpper, centre(column, row));
      // The top row and the left column belong to the square, the bottom row and the right column do not.
      EXPECT_EQ(times, row < 4 && column < 4 ? 1 : 0) << column << ", " << row;
      // The diagonal is a left edge of the upper triangle.
      if (row == column && row < 4) {
        EXPECT_TRUE(covers(kUpper, centre(column, row)));
      }
    }
  }
}

TEST(OracleExact, BackFacesAndDegenerateTrianglesCoverNothing) {
  const GridTriangle back{{kTopLeft, kTopRight, kBottomRight}};
  const GridTriangle line{{kTopLeft, kBottomRight, centre(2, 2)}};
  const GridTriangle point{{kTopLeft, kTopLeft, kTopLeft}};
  for (int row = 0; row <= 5; ++row) {
    for (int column = 0; column <= 5; ++column) {
      for (const GridTriangle& triangle : {back, line, point})
        EXPECT_FALSE(covers(triangle, centre(column, row)));
    }
  }
}

TEST(OracleExact, NothingOverflowsFarOut) {
  const std::int64_t far = std::int64_t{1} << 40;
  const GridTriangle triangle{{GridPoint{-far, -far}, {-far, far}, {far, -far + 1}}};
  EXPECT_TRUE(covers(triangle, {-1, -1}));
  EXPECT_TRUE(covers(triangle, {0, 0})) << "one step of the far corner moves the edge by half a step here";
  EXPECT_FALSE(covers(triangle, {1, 1}));
}

TEST(OracleExact, NearestTriangleAndCountOfSamples) {
  const GridTriangle triangles[] = {{{kTopLeft, kBottomLeft, kBottomRight}, 5},
                                    {{kTopLeft, kBottomRight, kTopRight}, 3}};
  const ExactImage image = rasterizeExactly(triangles, 5, 5, raster::samplePattern(4));
  EXPECT_EQ(image.coveredSamples[2 * 5 + 1], 4);
  EXPECT_EQ(image.nearest[2 * 5 + 1], 0u);
  EXPECT_EQ(image.nearest[2 * 5 + 2], 1u) << "on the diagonal both have samples, the nearer counts";
  EXPECT_EQ(image.coveredSamples[0], 1)
      << "of the corner pixel only the last sample lies right of and below its centre";
  EXPECT_EQ(image.nearest[4 * 5 + 4], 1u) << "only the sample at (96, 32) lies left of and above the centre";
  EXPECT_EQ(image.nearest[4 * 5 + 0], 0u);
}

}  // namespace
}  // namespace limn::test
