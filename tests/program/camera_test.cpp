// The camera against projective geometry worked out by hand.
#include "apps/scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <stdexcept>

namespace {

using limn::Projection;
using limn::scene::CameraView;
using limn::scene::LookAt;
using limn::scene::Sphere;

struct Pixel {
  double x, y;
};

Pixel project(const CameraView& view, const glm::dvec3& world) {
  const glm::dvec4 p = view.worldToView * glm::dvec4(world, 1.0);
  const Projection& projection = view.projection;
  const double w = projection.perspective ? -p.z : 1.0;
  return {0.5 * projection.width + p.x / w * projection.pixelsX,
          0.5 * projection.height - p.y / w * projection.pixelsY};
}

/// Radius in pixels of the outline of a sphere on the axis, by the tangent cone.
double outlineRadius(const CameraView& view, const Sphere& sphere) {
  const glm::dvec3 center(view.worldToView * glm::dvec4(sphere.center, 1.0));
  EXPECT_NEAR(center.x, 0.0, 1e-9 * std::abs(center.z));
  EXPECT_NEAR(center.y, 0.0, 1e-9 * std::abs(center.z));
  const double d = -center.z, r = sphere.radius;
  return view.projection.pixelsX * (view.projection.perspective ? r / std::sqrt(d * d - r * r) : r);
}

TEST(FrameSphere, TouchesTheMarginOfTheSmallerSide) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const Sphere sphere{{20 * unit(random) - 10, 20 * unit(random) - 10, 20 * unit(random) - 10},
                        std::pow(10.0, 6 * unit(random) - 3)};
    const int width = 1 + static_cast<int>(2000 * unit(random)),
              height = 1 + static_cast<int>(2000 * unit(random));
    const double azimuth = 720 * unit(random) - 360, elevation = 180 * unit(random) - 90;
    const double zoom = 0.25 + 4 * unit(random), fov = 1 + 150 * unit(random);
    const double ortho = i % 3 == 0 ? -1.0 : 0.0;
    const LookAt lookAt =
        limn::scene::frameSphere(sphere, width, height, azimuth, elevation, zoom, fov, ortho);
    const CameraView view = limn::scene::makeCamera(lookAt, sphere, width, height);
    const double expected = 0.95 * 0.5 * std::min(width, height) * zoom;
    EXPECT_NEAR(outlineRadius(view, sphere) / expected, 1.0, 1e-6)
        << i << ": " << width << 'x' << height << " azimuth " << azimuth << " elevation " << elevation
        << " fov " << fov;
  }
}

TEST(FrameSphere, AzimuthZeroLooksAlongMinusZAndPositiveTurnsTheEyeRight) {
  const Sphere sphere{{1, 2, 3}, 2};
  const auto towardsEye = [&](double azimuth, double elevation) {
    return glm::normalize(limn::scene::frameSphere(sphere, 100, 100, azimuth, elevation, 1, 30, 0).eye -
                          sphere.center);
  };
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-14; };
  EXPECT_TRUE(near(towardsEye(0, 0), {0, 0, 1}));
  EXPECT_TRUE(near(towardsEye(90, 0), {1, 0, 0}));
  EXPECT_TRUE(near(towardsEye(-90, 0), {-1, 0, 0}));
  EXPECT_TRUE(near(towardsEye(0, 90), {0, 1, 0}));
  EXPECT_TRUE(near(towardsEye(123, -90), {0, -1, 0}));
}

TEST(FrameSphere, StraightFromAboveKeepsTheHeading) {
  const Sphere sphere{{0, 0, 0}, 1};
  const CameraView view =
      limn::scene::makeCamera(limn::scene::frameSphere(sphere, 200, 200, 0, 90, 1, 30, 0), sphere, 200, 200);
  const Pixel away = project(view, {0, 0, -0.5});  // what lies behind is on top
  EXPECT_NEAR(away.x, 100, 1e-9);
  EXPECT_LT(away.y, 100);
}

TEST(FrameSphere, ZoomMagnifiesExactlyInThePicturePlane) {
  const Sphere sphere{{0, 0, 0}, 1};
  const auto viewOf = [&](double zoom, double ortho) {
    return limn::scene::makeCamera(limn::scene::frameSphere(sphere, 640, 480, 30, 20, zoom, 30, ortho),
                                   sphere, 640, 480);
  };
  for (const double ortho : {0.0, -1.0, 3.0}) {
    const Pixel once = project(viewOf(1, ortho), {0.3, 0.2, 0.4});
    const Pixel thrice = project(viewOf(3, ortho), {0.3, 0.2, 0.4});
    EXPECT_NEAR((thrice.x - 320) / (once.x - 320), 3, 1e-5);
    EXPECT_NEAR((thrice.y - 240) / (once.y - 240), 3, 1e-5);
  }
}

TEST(FrameSphere, APointIsFramedToo) {
  const Sphere point{{5, 6, 7}, 0};
  const CameraView view =
      limn::scene::makeCamera(limn::scene::frameSphere(point, 100, 50, 30, 20, 1, 30, 0), point, 100, 50);
  const Pixel p = project(view, point.center);
  EXPECT_NEAR(p.x, 50, 1e-6);
  EXPECT_NEAR(p.y, 25, 1e-6);
  EXPECT_LT(view.projection.nearPlane, view.projection.farPlane);
}

TEST(FrameSphere, TheLargestAndSmallestScenesAreFramedLikeAnyOther) {
  const Sphere unit{{0, 0, 0}, 1.0};
  const Sphere largest{{0, 0, 0}, 1.8e15};  // corners at 1e15 in all three directions
  const Sphere smallest{{0, 0, 0}, 1e-15};
  const auto outline = [](const Sphere& sphere) {
    return outlineRadius(makeCamera(frameSphere(sphere, 400, 300, 30, 20, 1, 30, 0), sphere, 400, 300),
                         sphere);
  };
  for (const Sphere& sphere : {largest, smallest})
    EXPECT_NEAR(outline(sphere), outline(unit), 1e-6 * outline(unit));
}

TEST(MakeCamera, VerticalFieldOfViewAndOrthographicHeightFillTheWindow) {
  LookAt lookAt{{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 60, 0};
  const Sphere sphere{{0, 0, 0}, 1};
  const double halfHeight = 10 * std::tan(30 * 3.14159265358979323846 / 180);
  CameraView view = limn::scene::makeCamera(lookAt, sphere, 300, 200);
  EXPECT_NEAR(project(view, {0, halfHeight, 0}).y, 0, 1e-4);
  EXPECT_NEAR(project(view, {0, -halfHeight, 0}).y, 200, 1e-4);
  EXPECT_GT(project(view, {1, 0, 0}).x, 150);
  lookAt.orthoHeight = 4;
  view = limn::scene::makeCamera(lookAt, sphere, 300, 200);
  EXPECT_FALSE(view.projection.perspective);
  EXPECT_NEAR(project(view, {0, 2, 0}).y, 0, 1e-4);
  EXPECT_NEAR(project(view, {3, 0, 0}).x, 300, 1e-4);
}

TEST(MakeCamera, NearAndFarEncloseTheSphere) {
  const Sphere sphere{{1, 0, 0}, 2};
  for (const double distance : {0.0, 0.5, 3.0, 100.0, 1e6}) {
    const LookAt lookAt{{1, 0, distance}, {1, 0, distance - 1}, {0, 1, 0}, 30, 0};
    const Projection p = limn::scene::makeCamera(lookAt, sphere, 10, 10).projection;
    EXPECT_GE(p.farPlane, distance + 2);
    EXPECT_GT(p.nearPlane, 0);
    EXPECT_GE(p.nearPlane, p.farPlane / 4096 * 0.999);
    if (distance > 3) {
      EXPECT_LE(p.nearPlane, distance - 2);
    }
  }
}

TEST(MakeCamera, RefusesDegenerateCameras) {
  const Sphere sphere{{0, 0, 0}, 1};
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [&](const LookAt& lookAt, int width = 100, int height = 100) {
    EXPECT_THROW(limn::scene::makeCamera(lookAt, sphere, width, height), std::invalid_argument);
  };
  refuses({{1, 2, 3}, {1, 2, 3}, {0, 1, 0}, 30, 0});
  refuses({{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 30, 0});
  refuses({{0, 0, 5}, {0, 0, 0}, {0, 0, 0}, 30, 0});
  refuses({{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0, 0});
  refuses({{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 180, 0});
  refuses({{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, nan, 0});
  refuses({{0, 0, infinity}, {0, 0, 0}, {0, 1, 0}, 30, 0});
  refuses({{0, nan, 1}, {0, 0, 0}, {0, 1, 0}, 30, 0});
  refuses({{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30, -1});
  const LookAt good{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30, 0};
  refuses(good, 0, 100);
  refuses(good, 100, -1);
  refuses(good, 16385, 100);
  EXPECT_NO_THROW(limn::scene::makeCamera(good, sphere, 16384, 1));
  EXPECT_THROW(limn::scene::frameSphere(sphere, 10, 10, 0, 0, 0, 30, 0), std::invalid_argument);
  EXPECT_THROW(limn::scene::frameSphere(sphere, 10, 10, nan, 0, 1, 30, 0), std::invalid_argument);
}

TEST(FileCamera, ShowsAllThatItSeesWhateverTheWindow) {
  limn::scene::Camera camera;
  camera.yfov = 1.0;
  camera.aspect = 2.0;
  const Sphere sphere{{0, 0, -5}, 1};
  const double top = std::tan(0.5), side = 2 * top;
  // As wide as the camera, wider, narrower: the corners of its own view stay in the window, and one pair of
  // sides fits.
  for (const int width : {200, 400, 80}) {
    const CameraView view = limn::scene::makeCamera(camera, glm::dmat4(1.0), sphere, width, 100);
    const Pixel corner = project(view, {side, top, -1});
    EXPECT_LE(corner.x, width + 1e-4);
    EXPECT_GE(corner.y, -1e-4);
    EXPECT_NEAR(std::min(width - corner.x, corner.y), 0, 1e-4) << width;
    EXPECT_EQ(view.projection.pixelsX, view.projection.pixelsY);
  }
}

TEST(FileCamera, IgnoresScaleAndKeepsItsPlace) {
  const limn::scene::Camera camera;
  glm::dmat4 node(1.0);
  node[0] *= 3.0, node[1] *= 0.5, node[2] *= 7.0;
  node[3] = glm::dvec4(1, 2, 10, 1);
  const Sphere sphere{{1, 2, 0}, 1};
  const CameraView scaled = limn::scene::makeCamera(camera, node, sphere, 64, 64);
  const Pixel p = project(scaled, {1, 2, 0});
  EXPECT_NEAR(p.x, 32, 1e-12);
  EXPECT_NEAR(p.y, 32, 1e-12);
  EXPECT_NEAR(-(scaled.worldToView * glm::dvec4(1, 2, 0, 1)).z, 10, 1e-12);
  for (const double scale : {0.0, 1e19, 1e160}) {  // squares of the last are no numbers
    for (const int axis : {1, 2}) {
      glm::dmat4 lost = node;
      lost[axis] *= scale;
      EXPECT_THROW(limn::scene::makeCamera(camera, lost, sphere, 64, 64), std::invalid_argument) << scale;
    }
  }
}

TEST(FileCamera, KeepsItsOwnNearAndFarPlanes) {
  limn::scene::Camera camera;
  camera.nearPlane = 4.5;
  camera.farPlane = 5.5;
  const Projection p = limn::scene::makeCamera(camera, glm::dmat4(1.0), {{0, 0, -5}, 1}, 64, 64).projection;
  EXPECT_FLOAT_EQ(p.nearPlane, 4.5f);
  EXPECT_FLOAT_EQ(p.farPlane, 5.5f);
}

TEST(FileCamera, PlanesThatFloatsCannotTellApartAreMovedApart) {
  struct Case {
    double nearPlane, farPlane;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Case& c :
       {Case{1e8, infinity}, Case{1.0, 1.00000001}, Case{1e38, infinity}, Case{4.5, 4.5000001}})
    for (const bool perspective : {true, false}) {
      limn::scene::Camera camera;
      camera.perspective = perspective;
      camera.xmag = camera.ymag = 1.0;
      camera.nearPlane = c.nearPlane;
      camera.farPlane = c.farPlane;
      const Projection p =
          limn::scene::makeCamera(camera, glm::dmat4(1.0), {{0, 0, -5}, 10}, 64, 64).projection;
      EXPECT_FLOAT_EQ(p.nearPlane, static_cast<float>(c.nearPlane));
      EXPECT_LT(p.nearPlane, p.farPlane);
      EXPECT_TRUE(std::isfinite(p.farPlane));
    }
}

TEST(TurnAbout, QuarterTurnsAreExactAndCounterClockwise) {
  const glm::dmat4 quarter = limn::scene::turnAbout({1, 0, 0}, {0, 2, 0}, 90);
  EXPECT_EQ(glm::dvec3(quarter * glm::dvec4(2, 5, 0, 1)), glm::dvec3(1, 5, -1));
  EXPECT_EQ(limn::scene::turnAbout({1, 2, 3}, {1, 1, 0}, 360), glm::dmat4(1.0));
  EXPECT_THROW(limn::scene::turnAbout({0, 0, 0}, {0, 0, 0}, 1), std::invalid_argument);
}

}  // namespace
