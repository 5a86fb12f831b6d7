#include "bench/measure/mask.h"

#include <gtest/gtest.h>

#include <random>

#include "raster/base/elementary.h"
#include "tests/measure/window.h"

namespace limn::measure {
namespace {

// Whether a sample's centre is inside, by three exact edge functions and the top-left rule.
bool covers(const SampleTriangle& t, int column, int row) {
  const std::int64_t px = column * 256 + 128, py = row * 256 + 128;
  const auto area =
      std::int64_t(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - std::int64_t(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
  if (area == 0) return false;
  for (int i = 0; i < 3; ++i) {
    const int a = area > 0 ? i : (i + 1) % 3, b = area > 0 ? (i + 1) % 3 : i;
    const std::int64_t dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
    const std::int64_t side = dx * (py - t.y[a]) - dy * (px - t.x[a]);
    const bool topLeft = dy < 0 || (dy == 0 && dx > 0);  // clockwise on a window whose y points down
    if (side < 0 || (side == 0 && !topLeft)) return false;
  }
  return true;
}

TEST(Mask, AgreesWithEdgeFunctionsSampleBySample) {
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    const int spread = round % 3 == 0 ? 700 : round % 3 == 1 ? 9000 : 40000;
    const int grid =
        round % 2 == 0 ? 1 : 128;  // every second one has corners on centres and edges through them
    std::uniform_int_distribution<int> coordinate(-spread / 4, spread);
    SampleTriangle triangle{};
    for (int i = 0; i < 3; ++i) {
      triangle.x[i] = coordinate(random) / grid * grid;
      triangle.y[i] = coordinate(random) / grid * grid;
    }
    Mask mask(5, 4);
    mask.draw(std::span(&triangle, 1));
    for (int y = 0; y < mask.rows(); ++y) {
      for (int x = 0; x < mask.columns(); ++x) {
        ASSERT_EQ(mask.at(x, y), covers(triangle, x, y))
            << "round " << round << ", sample " << x << ", " << y;
      }
    }
  }
}

TEST(Mask, AreaOfPolygonsIsRight) {
  const auto square = std::vector<glm::dvec2>{{10, 10}, {110, 10}, {110, 60}, {10, 60}};
  EXPECT_DOUBLE_EQ(drawnPolygon(square, 128).area(), 5000.0);
  const double disc = drawnPolygon(regularPolygon({256, 256}, 200, 2000), 512).area();
  EXPECT_NEAR(disc, kPi * 200 * 200, 2.0);
}

TEST(Mask, ClearedMaskIsEmpty) {
  Mask mask = drawnPolygon(regularPolygon({64, 64}, 50, 7), 128);
  EXPECT_GT(mask.area(), 0.0);
  mask.clear();
  EXPECT_EQ(mask.area(), 0.0);
}

TEST(Mask, NearPlaneAndFarCornersAreClipped) {
  // A floor that runs from behind the eye to the horizon: everything below the middle of the window.
  Surface floor;
  floor.positions = {{-1e7, -1, 1e4}, {1e7, -1, 1e4}, {1e7, -1, -1e7}, {-1e7, -1, -1e7}};
  floor.indices = {0, 1, 2, 0, 2, 3};
  scene::CameraView camera;
  camera.projection = {true, 100.0f, 100.0f, 0.001f, 1e8f, 200, 200};
  std::vector<SampleTriangle> triangles;
  project(floor, camera, triangles);
  Mask mask(200, 200);
  mask.draw(triangles);
  EXPECT_NEAR(mask.area(), 200.0 * 100.0, 200.0 / kSamplesPerPixel);
}

// The measuring is measured: rings between discs of known radii.
TEST(DifferenceArea, OfTwoDiscsGivesTheirDifferenceOfRadius) {
  for (const double grow : {0.0, 0.0625, 0.25, 1.0, 3.0}) {
    const Mask small = drawnPolygon(regularPolygon({256.3, 255.8}, 200, 3000), 512);
    const Mask large = drawnPolygon(regularPolygon({256.3, 255.8}, 200 + grow, 3000), 512);
    const double offset = differenceArea(small, large) / (2 * kPi * 200);
    EXPECT_NEAR(offset, grow * (1 + grow / 400), 1.0 / 256) << grow;
  }
}

}  // namespace
}  // namespace limn::measure
