// The rasterizer's kernels against exact integers and long double.
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "bench/measure/extremes.h"
#include "bench/measure/stability.h"
#include "raster/clip.h"
#include "raster/triangle.h"
#include "raster/view.h"

namespace limn::measure {
namespace {

using raster::Corners;
using raster::kSubpixels;

__extension__ typedef __int128 Int128;  // the compilers' own, exact for every product here

Projection randomProjection(Extremes& random, double size) {
  Projection projection;
  projection.width = static_cast<int>(random.magnitude(1, 16384));
  projection.height = static_cast<int>(random.magnitude(1, 16384));
  projection.pixelsX = projection.pixelsY = static_cast<float>(random.magnitude(0.5, 4) * projection.height);
  projection.nearPlane = static_cast<float>(size * 1e-3);
  projection.farPlane = static_cast<float>(size * 1e4);  // near : far = 1 : 1e7
  return projection;
}

// A point of view space that is seen in the window.
glm::vec3 randomSeen(Extremes& random, const Projection& projection) {
  const double depth = random.magnitude(projection.nearPlane, projection.farPlane);
  return {static_cast<float>(random.uniform(-0.5, 0.5) * projection.width / projection.pixelsX * depth),
          static_cast<float>(random.uniform(-0.5, 0.5) * projection.height / projection.pixelsY * depth),
          static_cast<float>(-depth)};
}

// Where a point of view space is seen, in pixels from the window's upper left corner.
std::array<long double, 2> seenAt(const Vec3L& p, const Projection& projection) {
  return {projection.width / 2.0L - p.x / p.z * projection.pixelsX,
          projection.height / 2.0L + p.y / p.z * projection.pixelsY};
}

void seeDistance(Largest& largest, std::int32_t x, std::int32_t y, const std::array<long double, 2>& truth) {
  largest.see(x / static_cast<long double>(kSubpixels) - truth[0]);
  largest.see(y / static_cast<long double>(kSubpixels) - truth[1]);
}

// The largest error that `compare(map, projection, point, largest)` sees at points in sight.
template <class Compare>
double largestOfSeen(std::uint64_t seed, std::size_t cases, const Compare& compare) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const Projection projection = randomProjection(random, random.magnitude(1e-6, 1e6));
    const glm::vec3 point = randomSeen(random, projection);
    compare(raster::ScreenMap(projection), projection, point, largest);
  }
  return largest.value();
}

double snapError(std::uint64_t seed, std::size_t cases) {
  return largestOfSeen(seed, cases,
                       [](const raster::ScreenMap& map, const Projection& projection, const glm::vec3& point,
                          Largest& largest) {
                         const raster::ScreenVertex v = map.project(point);
                         seeDistance(largest, v.x, v.y, seenAt(Vec3L(point), projection));
                       });
}

double depthError(std::uint64_t seed, std::size_t cases) {
  return largestOfSeen(
      seed, cases,
      [](const raster::ScreenMap& map, const Projection&, const glm::vec3& point, Largest& largest) {
        const double depth = map.viewDepth(map.project(point).depth);
        largest.see((depth + double(point.z)) / (std::abs(double(point.z)) * 0x1p-24));
      });
}

// Corners anywhere in the guard band, or close together.
Corners randomCorners(Extremes& random) {
  constexpr double kReach = (raster::kGuardPixels + 16384.0) * kSubpixels;
  const double size = random.magnitude(1, kReach / 2);
  Corners corners;
  const double x = random.uniform(-kReach / 2, kReach / 2), y = random.uniform(-kReach / 2, kReach / 2);
  for (int i = 0; i < 3; ++i) {
    corners.x[i] = static_cast<std::int32_t>(x + random.uniform(-size, size) * 0.5);
    corners.y[i] = static_cast<std::int32_t>(y + random.uniform(-size, size) * 0.5);
  }
  return corners;
}

// In square sub-pixels; the rule for samples on an edge is part of the value.
double edgeError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const Corners c = randomCorners(random);
    const raster::Edge edge = raster::Edge::of(c, 0, 1);
    const auto x = static_cast<std::int32_t>(random.uniform(0, 16384.0 * kSubpixels));
    const auto y = static_cast<std::int32_t>(random.uniform(0, 16384.0 * kSubpixels));
    const Int128 dx = Int128(c.x[1]) - c.x[0], dy = Int128(c.y[1]) - c.y[0];
    const bool topLeft = dy < 0 || (dy == 0 && dx > 0);
    const Int128 truth = dx * (Int128(y) - c.y[0]) - dy * (Int128(x) - c.x[0]) - (topLeft ? 0 : 1);
    largest.see(static_cast<long double>(Int128(edge.at(x, y)) - truth));
    const Int128 area = (Int128(c.x[1]) - c.x[0]) * (Int128(c.y[2]) - c.y[0]) -
                        (Int128(c.x[2]) - c.x[0]) * (Int128(c.y[1]) - c.y[0]);
    largest.see(static_cast<long double>(Int128(raster::signedArea(c)) - area));
  }
  return largest.value();
}

// A value at a covered sample, from its planes; as a share of the largest corner value.
double planeError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases;) {
    Corners c = randomCorners(random);
    std::int64_t area = raster::signedArea(c);
    if (area < 0) std::swap(c.x[1], c.x[2]), std::swap(c.y[1], c.y[2]), area = -area;
    long double longest = 0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, std::hypot((long double)(c.x[(k + 1) % 3] - c.x[k]),
                                             (long double)(c.y[(k + 1) % 3] - c.y[k])));
    }
    // Heights of half a pixel or aspects below 1:100 (see the domain).
    if (area < 128 * longest || static_cast<long double>(area) * 100 < longest * longest) continue;
    ++i;
    const std::array<float, 3> value{static_cast<float>(random.uniform(-1, 1)),
                                     static_cast<float>(random.uniform(-1, 1)),
                                     static_cast<float>(random.uniform(-1, 1))};
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto x = static_cast<std::int32_t>(c.x[0] + u * (c.x[1] - c.x[0]) + v * (c.x[2] - c.x[0]));
    const auto y = static_cast<std::int32_t>(c.y[0] + u * (c.y[1] - c.y[0]) + v * (c.y[2] - c.y[0]));
    if (!raster::covers(c, x, y)) continue;
    const raster::Slopes s = raster::PlaneBasis(c).slopes(value[0], value[1], value[2]);
    const float drawn =
        (value[0] + s.y * static_cast<float>(y - c.y[0])) + s.x * static_cast<float>(x - c.x[0]);
    const auto weight = [&](int a, int b) {
      return ((long double)(c.x[b] - c.x[a]) * (y - c.y[a]) - (long double)(c.y[b] - c.y[a]) * (x - c.x[a])) /
             area;
    };
    const long double truth = weight(1, 2) * value[0] + weight(2, 0) * value[1] + weight(0, 1) * value[2];
    const float most = std::max({std::abs(value[0]), std::abs(value[1]), std::abs(value[2])});
    largest.see((drawn - truth) / most);
  }
  return largest.value();
}

/// A triangle alone in its batch, in view space.
class LoneTriangle {
 public:
  explicit LoneTriangle(const std::array<glm::vec3, 3>& corners) {
    set_.clusters = {{0, 0, 3, 1, 0}};
    set_.points.resize(3);
    for (std::uint8_t k = 0; k < 3; ++k) {
      set_.corners[k] = {k};
      set_.points.set(k, corners[k], {0.0f, 0.0f, 1.0f});
    }
    batch_.set = &set_;
    batch_.points = &set_.points;
    batch_.toView = raster::Affine(glm::mat4(1.0f));
    for (int i = 0; i < 3; ++i) batch_.normalRows[i][i] = 1.0f;
  }
  void clip(const raster::ScreenMap& map, std::vector<raster::LooseTriangle>& parts) const {
    parts.clear();
    raster::clipTriangle(batch_, {0, 0, 0}, map, parts);
  }

 private:
  raster::ClusterSet set_;
  raster::Batch batch_{};
};

/// Sutherland and Hodgman in long double, against the planes that the rasterizer names; `isClear` tells whether all
/// corners are well inside or outside of every plane.
std::vector<Vec3L> clipped(const std::array<glm::vec3, 3>& corners, const Projection& projection,
                           bool& isClear) {
  const long double x = (0.5L * projection.width + raster::kGuardPixels - 1) / projection.pixelsX;
  const long double y = (0.5L * projection.height + raster::kGuardPixels - 1) / projection.pixelsY;
  const long double nearPlane = projection.nearPlane, farPlane = projection.farPlane;
  const auto distance = [&](int plane, const Vec3L& p) {
    const std::array<long double, 6> all{-p.z - nearPlane, farPlane + p.z, p.x - p.z * x,
                                         -p.z * x - p.x,   -p.z * y - p.y, p.y - p.z * y};
    return all[static_cast<std::size_t>(plane)];
  };
  std::vector<Vec3L> polygon;
  for (const glm::vec3& corner : corners) polygon.emplace_back(corner);
  isClear = true;
  for (int plane = 0; plane < 6; ++plane) {
    std::vector<Vec3L> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3L &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const long double da = distance(plane, a), db = distance(plane, b);
      isClear = isClear && std::abs(da) > 1e-5L * (std::abs(a.x) + std::abs(a.y) + std::abs(a.z) + nearPlane);
      if (da >= 0) kept.push_back(a);
      if ((da >= 0) != (db >= 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    polygon = kept;
  }
  return polygon;
}

bool reachesWindow(const std::vector<Vec3L>& polygon, const Projection& projection) {
  const std::array<int, 2> size{projection.width, projection.height};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    long double low = std::numeric_limits<long double>::infinity(), high = -low;
    for (const Vec3L& p : polygon) {
      const long double at = seenAt(p, projection)[axis];
      low = std::min(low, at), high = std::max(high, at);
    }
    if (!(low < size[axis] - 1 && high > 1)) return false;
  }
  return true;
}

// How far corners of what is left of a triangle are from those of the exact polygon, in pixels; the number of parts
// must be the same.
double clipError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  std::vector<raster::LooseTriangle> parts;
  for (std::size_t i = 0; i < cases;) {
    const double size = random.magnitude(1e-6, 1e6);
    const Projection projection = randomProjection(random, size);
    std::array<glm::vec3, 3> corners;
    for (glm::vec3& corner : corners) {
      const double distance = random.magnitude(projection.nearPlane, 10.0 * projection.farPlane);
      corner = random.oneIn(2) ? randomSeen(random, projection) : glm::vec3(distance * random.unit());
    }
    bool isClear = false;
    const std::vector<Vec3L> truth = clipped(corners, projection, isClear);
    if (!isClear || truth.size() < 3 || !reachesWindow(truth, projection)) continue;
    ++i;
    LoneTriangle(corners).clip(raster::ScreenMap(projection), parts);
    if (parts.size() + 2 != truth.size()) {
      largest.see(std::numeric_limits<long double>::infinity());
      continue;
    }
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const std::array<std::size_t, 3> corner{0, part + 1, part + 2};
      for (std::size_t k = 0; k < 3; ++k) {
        const Corners& drawn = parts[part].corners;
        seeDistance(largest, drawn.x[k], drawn.y[k], seenAt(truth[corner[k]], projection));
      }
    }
  }
  return largest.value();
}

constexpr const char* kWindow =
    "windows of 1 to 16384 pixels, sizes 1e-6 to 1e6, near : far = 1 : 1e7, points in sight";
constexpr const char* kCrossing =
    "windows of 1 to 16384 pixels, sizes 1e-6 to 1e6, near : far = 1 : 1e7, triangles that cross any planes";
constexpr const char* kGuard = "corners within 8191 pixels of the window";

constexpr std::array kChecks{
    KernelCheck{"projection and snapping", "pixels, half a grid step of 1/512 included", 0.004, kWindow,
                "beyond the guard band triangles are clipped first", snapError},
    KernelCheck{"view depth", "ulp of a float", 2.0, kWindow,
                "before the near plane triangles are clipped first", depthError},
    KernelCheck{"clipping", "pixels, half a grid step of 1/512 included", 0.01, kCrossing,
                "parts before the near plane, beyond the far one or outside the guard band are not drawn",
                clipError},
    KernelCheck{"edge function", "square sub-pixels", 0.0, kGuard, "clipped first", edgeError},
    KernelCheck{
        "interpolation over a triangle", "largest corner value", 1e-4,
        "heights of half a pixel or more, up to 100 times as long as high, anywhere in the guard band",
        "grows with the aspect; slivers vary along their longer edge only and stay within the corners' range "
        "of it",
        planeError},
};

}  // namespace

std::span<const KernelCheck> rasterChecks() {
  return kChecks;
}

}  // namespace limn::measure
