// Anti-aliasing: coverage of half-planes and discs by the sample patterns.
#include <gtest/gtest.h>

#include <cmath>

#include "raster/base/elementary.h"
#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

// Alpha, in [0, 1], of a soup over nothing.
std::vector<double> coverage(const Soup& soup, int size, int samples) {
  const Geometry geometry = soup.geometry();
  Scene scene(pixelProjection(size, size));
  scene.frame.samples = samples;
  scene.draws[0].geometry = &geometry;
  Renderer renderer(1);
  const Picture p = scene.draw(renderer);
  std::vector<double> alpha;
  for (std::size_t i = 3; i < p.rgba.size(); i += 4) alpha.push_back(p.rgba[i] / 255.0);
  return alpha;
}

// Area of the unit square about (x, y) on the inner side of n · p <= 0, by clipping the square.
double halfPlaneArea(double nx, double ny, double x, double y) {
  double px[5], py[5], area = 0.0;
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    const auto corner = [&](int k, double& cx, double& cy) {
      cx = x + ((k % 4 == 0 || k % 4 == 3) ? -0.5 : 0.5), cy = y + (k % 4 < 2 ? -0.5 : 0.5);
      return nx * cx + ny * cy;
    };
    double ax, ay, bx, by;
    const double da = corner(i, ax, ay), db = corner(i + 1, bx, by);
    if (da <= 0.0) px[count] = ax, py[count++] = ay;
    if ((da <= 0.0) != (db <= 0.0)) {
      const double t = da / (da - db);
      px[count] = ax + (bx - ax) * t, py[count++] = ay + (by - ay) * t;
    }
  }
  for (int i = 0; i < count; ++i) area += px[i] * py[(i + 1) % count] - px[(i + 1) % count] * py[i];
  return 0.5 * area;
}

TEST(Samples, HalfPlanesAreGradedAtEveryAngle) {
  constexpr int kSize = 24;
  for (const auto& [samples, bound] : {std::pair(1, 0.51), std::pair(4, 0.38), std::pair(8, 0.27)})
    for (int degrees = 0; degrees < 360; degrees += 7) {
      const SinCos a = sinCosDegrees(degrees + 0.3);
      const double nx = a.cos, ny = a.sin;
      const auto at = [&](double along, double across) {
        return glm::vec3(static_cast<float>(-ny * along + nx * across),
                         static_cast<float>(nx * along + ny * across), -1.0F);
      };
      Soup soup;  // the side n · p <= 0, y up
      soup.triangle(at(60, 0), at(-60, 0), at(0, -200));
      if (const glm::vec3 e = at(-60, 0) - at(60, 0), f = at(0, -200) - at(60, 0); e.x * f.y - e.y * f.x < 0)
        std::swap(soup.indices[1], soup.indices[2]);
      const std::vector<double> alpha = coverage(soup, kSize, samples);
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const double area = halfPlaneArea(nx, ny, x + 0.5 - kSize / 2, kSize / 2 - (y + 0.5));
          EXPECT_LE(std::abs(alpha[static_cast<std::size_t>(y * kSize + x)] - area), bound)
              << samples << " samples, " << degrees << " degrees, pixel " << x << ' ' << y;
        }
    }
}

TEST(Samples, ADiscsMeanErrorShrinksWithTheirNumber) {
  constexpr int kSize = 64, kSides = 720;
  constexpr double kRadius = 25.3, kCx = 0.37, kCy = -0.21;
  Soup soup;
  for (int i = 0; i < kSides; ++i) {
    const auto rim = [&](int k) {
      const SinCos a = sinCosDegrees(360.0 * k / kSides);
      return glm::vec3(static_cast<float>(kCx + kRadius * a.cos), static_cast<float>(kCy + kRadius * a.sin),
                       -1.0F);
    };
    soup.triangle({static_cast<float>(kCx), static_cast<float>(kCy), -1.0F}, rim(i), rim(i + 1));
  }
  for (const auto& [samples, bound] : {std::pair(1, 0.3), std::pair(4, 0.09), std::pair(8, 0.06)}) {
    const std::vector<double> alpha = coverage(soup, kSize, samples);
    double error = 0.0;
    int border = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        int inside = 0;  // the truth by 32 × 32 points
        for (int k = 0; k < 1024; ++k) {
          const double px = x + (k % 32 + 0.5) / 32 - kSize / 2 - kCx,
                       py = kSize / 2 - (y + (k / 32 + 0.5) / 32) - kCy;
          inside += px * px + py * py <= kRadius * kRadius;
        }
        if (inside == 0 || inside == 1024) continue;
        ++border;
        error += std::abs(alpha[static_cast<std::size_t>(y * kSize + x)] - inside / 1024.0);
      }
    EXPECT_LE(error / border, bound) << samples;
    EXPECT_GT(border, 150);
  }
}

}  // namespace
}  // namespace limn::raster::test
