#include "bench/measure/outline.h"

#include <gtest/gtest.h>

#include "raster/base/elementary.h"
#include "tests/measure/window.h"

namespace limn::measure {
namespace {

constexpr int kSize = 1024;
constexpr double kSixteenth = 1.0 / 16;

Outline outlineOf(const std::vector<glm::dvec2>& points) {
  return traceOutline(drawnPolygon(points, kSize));
}

std::vector<glm::dvec2> disc(double radius, glm::dvec2 center = {512.4, 511.7}) {
  return regularPolygon(center, radius, 4000);
}

TEST(Length, OfDiscsIsWithinAThousandth) {
  for (const double radius : {20.0, 57.3, 133.0, 440.0}) {
    EXPECT_NEAR(length(outlineOf(disc(radius))) / (2 * kPi * radius), 1.0, 1e-3) << radius;
  }
}

TEST(Length, OfPolygonsAtAnyAngleIsWithinAThousandth) {
  for (int sides = 3; sides <= 24; ++sides) {
    const auto polygon = regularPolygon({510.2, 507.9}, 430, sides, 0.07 * sides);
    EXPECT_NEAR(length(outlineOf(polygon)) / (2 * sides * 430 * std::sin(kPi / sides)), 1.0, 1e-3) << sides;
  }
}

TEST(Length, CountsHolesAndPieces) {
  Mask mask(64, 64);
  EXPECT_EQ(length(traceOutline(mask)), 0.0);
  Surface frame = convexPolygon({{10, 10}, {50, 10}, {50, 14}, {10, 14}}, 64);
  for (const auto& bar : {std::vector<glm::dvec2>{{10, 46}, {50, 46}, {50, 50}, {10, 50}},
                          {{10, 10}, {14, 10}, {14, 50}, {10, 50}},
                          {{46, 10}, {50, 10}, {50, 50}, {46, 50}}}) {
    const Surface more = convexPolygon(bar, 64);
    const auto base = static_cast<std::uint32_t>(frame.positions.size());
    frame.positions.insert(frame.positions.end(), more.positions.begin(), more.positions.end());
    for (const std::uint32_t index : more.indices) frame.indices.push_back(base + index);
  }
  const Outline outline = traceOutline(drawn(frame, 64));
  ASSERT_EQ(outline.contours.size(), 2u);
  EXPECT_NEAR(length(outline), 4 * 40 + 4 * 32, 0.5);
}

TEST(LargestTurn, OfRegularPolygonsIsTheirExteriorAngle) {
  for (int sides = 3; sides <= 30; ++sides) {
    const auto polygon = regularPolygon({510.2, 507.9}, 430, sides, 0.05 * sides);
    EXPECT_NEAR(largestTurn(outlineOf(polygon)), 360.0 / sides, 2.0) << sides;
  }
}

TEST(LargestTurn, OfDiscsIsSmall) {
  for (const double radius : {60.0, 133.0, 440.0}) {
    EXPECT_NEAR(largestTurn(outlineOf(disc(radius))), kCornerReach / radius * 180 / kPi, 2.0) << radius;
  }
}

TEST(OutlineDistance, OfDiscsIsTheDifferenceOfTheirRadii) {
  for (const double grow : {0.0, 0.3, 1.0, 7.0, 40.0}) {
    const OutlineDistance distance =
        outlineDistance(outlineOf(disc(400)), outlineOf(disc(400 + grow)), kSize, kSize);
    EXPECT_NEAR(distance.max, grow, kSixteenth) << grow;
    EXPECT_NEAR(distance.p95, grow, kSixteenth) << grow;
  }
}

TEST(OutlineDistance, OfMovedDiscsIsTheWay) {
  const OutlineDistance distance =
      outlineDistance(outlineOf(disc(300)), outlineOf(disc(300, {512.4 + 3.0, 511.7 + 4.0})), kSize, kSize);
  EXPECT_NEAR(distance.max, 5.0, kSixteenth);
  // The distance is 5 |cos φ| at angle φ to the way.
  EXPECT_NEAR(distance.p95, 5.0 * std::cos(0.05 * kPi / 2), kSixteenth);
}

TEST(OutlineDistance, OfADiscAndItsPolygonIsTheSagitta) {
  const OutlineDistance distance =
      outlineDistance(outlineOf(disc(400)), outlineOf(regularPolygon({512.4, 511.7}, 400, 16)), kSize, kSize);
  EXPECT_NEAR(distance.max, 400 * (1 - std::cos(kPi / 16)), kSixteenth);
}

TEST(OutlineDistance, SeesAThinSpikeToItsTip) {
  const auto body = regularPolygon({512, 512}, 200, 64, 0.0);
  const Surface spike = convexPolygon({{700, 511.9}, {900, 512}, {700, 512.1}}, kSize);
  Surface both = convexPolygon(body, kSize);
  const auto base = static_cast<std::uint32_t>(both.positions.size());
  both.positions.insert(both.positions.end(), spike.positions.begin(), spike.positions.end());
  for (const std::uint32_t index : spike.indices) both.indices.push_back(base + index);
  const OutlineDistance distance =
      outlineDistance(outlineOf(body), traceOutline(drawn(both, kSize)), kSize, kSize);
  // The spike is 3.2 samples thick at its root; where it is thinner than one it falls between the samples'
  // centres.
  EXPECT_NEAR(distance.max, 700 + 200 * (1 - 1 / 3.2) - 712, 0.25);
}

TEST(OutlineDistance, OfAnEmptyOutlineIsZero) {
  EXPECT_EQ(outlineDistance({}, outlineOf(disc(100)), kSize, kSize).max, 0.0);
}

}  // namespace
}  // namespace limn::measure
