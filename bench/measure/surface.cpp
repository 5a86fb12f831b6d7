#include "bench/measure/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <tuple>

#include "raster/base/check.h"
#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

// `rings` × `sides` quads that wrap both ways.
template <class Point>
Surface wrappedGrid(int rings, int sides, const Point& point) {
  Surface surface;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sides; ++j)
      surface.positions.push_back(point(2 * kPi * i / rings, 2 * kPi * j / sides));
  }
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(i % rings * sides + j % sides); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      for (const std::uint32_t index : {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j),
                                        vertex(i + 1, j + 1), vertex(i, j + 1)}) {
        surface.indices.push_back(index);
      }
    }
  }
  return surface;
}

// Sagitta of a circle's chord over 1/n of the circle.
double sagitta(double radius, int n) {
  return radius * (1.0 - sinCos(kPi / n).cos);
}

}  // namespace

AnalyticSurface sphereSurface(const glm::dvec3& center, double radius) {
  constexpr int kRows = 128;  // 8 · 128² triangles
  AnalyticSurface sphere;
  for (int octant = 0; octant < 8; ++octant) {
    const glm::dvec3 sign{octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
    const auto base = static_cast<std::uint32_t>(sphere.surface.positions.size());
    const auto vertex = [&](int i, int j) { return base + static_cast<std::uint32_t>(i * (i + 1) / 2 + j); };
    for (int i = 0; i <= kRows; ++i) {
      for (int j = 0; j <= i; ++j) {
        const glm::dvec3 flat(kRows - i, i - j, j);
        sphere.surface.positions.push_back(center + sign * glm::normalize(flat) * radius);
        if (i == kRows) continue;
        for (const std::uint32_t k : {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)}) {
          sphere.surface.indices.push_back(k);
        }
        if (j == i) continue;
        for (const std::uint32_t k : {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}) {
          sphere.surface.indices.push_back(k);
        }
      }
    }
  }
  const auto& [positions, indices] = sphere.surface;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3 a = positions[indices[i]], b = positions[indices[i + 1]], c = positions[indices[i + 2]];
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    sphere.error = std::max(sphere.error, radius - std::abs(glm::dot(normal, a - center)));
  }
  return sphere;
}

AnalyticSurface torusSurface(const glm::dvec3& center, double ring, double tube, int axis) {
  constexpr int kRings = 512, kSides = 256;
  AnalyticSurface torus;
  torus.surface = wrappedGrid(kRings, kSides, [&](double s, double a) {
    const SinCos along = sinCos(s), around = sinCos(a);
    const double reach = ring + tube * around.cos;
    glm::dvec3 point;
    point[axis] = tube * around.sin;
    point[(axis + 1) % 3] = reach * along.cos;
    point[(axis + 2) % 3] = reach * along.sin;
    return center + point;
  });
  torus.error = sagitta(ring + tube, kRings) + sagitta(tube, kSides);
  return torus;
}

namespace {

constexpr double kKnotTube = 0.55;

struct KnotFrame {
  glm::dvec3 point, normal, binormal;
};

KnotFrame knotFrame(double s) {
  const SinCos one = sinCos(s), two = sinCos(2 * s), three = sinCos(3 * s);
  KnotFrame frame;
  frame.point = {one.sin + 2 * two.sin, one.cos - 2 * two.cos, -three.sin};
  const glm::dvec3 tangent =
      glm::normalize(glm::dvec3(one.cos + 4 * two.cos, -one.sin + 4 * two.sin, -3 * three.cos));
  frame.binormal = glm::normalize(glm::cross(tangent, glm::dvec3(frame.point.x, frame.point.y, 0.0)));
  frame.normal = glm::cross(frame.binormal, tangent);
  return frame;
}

}  // namespace

AnalyticSurface knotSurface(const glm::dvec3& center, double scale) {
  constexpr int kRings = 1024, kSides = 160;
  AnalyticSurface knot;
  knot.surface = wrappedGrid(kRings, kSides, [&](double s, double a) {
    const KnotFrame frame = knotFrame(s);
    const SinCos around = sinCos(a);
    return center +
           scale * (frame.point + kKnotTube * (frame.normal * around.cos + frame.binormal * around.sin));
  });
  // Second derivative of the surface along s: of the curve at most 1 + 8 + 9, of the frame's part less than
  // as much.
  constexpr double kStep = 2 * kPi / kRings;
  knot.error = scale * (36.0 * kStep * kStep / 8.0 + sagitta(kKnotTube, kSides));
  return knot;
}

AnalyticSurface coneSurface(const glm::dvec3& base, const glm::dvec3& apex, double radius) {
  constexpr int kSides = 4096;
  const glm::dvec3 axis = glm::normalize(apex - base);
  const glm::dvec3 other = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
  AnalyticSurface cone;
  cone.surface.positions = {base, apex};
  for (int i = 0; i < kSides; ++i) {
    const SinCos angle = sinCos(2 * kPi * i / kSides);
    cone.surface.positions.push_back(base + radius * (u * angle.cos + v * angle.sin));
    const auto here = static_cast<std::uint32_t>(2 + i),
               next = static_cast<std::uint32_t>(2 + (i + 1) % kSides);
    for (const std::uint32_t k : {here, next, 1U, next, here, 0U}) cone.surface.indices.push_back(k);
  }
  cone.error = sagitta(radius, kSides);
  return cone;
}

// Badoiu & Clarkson, "Smaller core-sets for balls", 2003: ever smaller steps towards the farthest point.
scene::Sphere boundingSphere(const Surface& surface) {
  require(!surface.positions.empty(), "a surface without points has no bounds");
  glm::dvec3 center = surface.positions.front(), farthest = center;
  const auto findFarthest = [&] {
    double most = -1.0;
    for (const glm::dvec3& point : surface.positions) {
      const glm::dvec3 way = point - center;
      if (glm::dot(way, way) <= most) continue;
      most = glm::dot(way, way);
      farthest = point;
    }
    return std::sqrt(most);
  };
  constexpr int kSteps = 200;
  for (int step = 1; step <= kSteps; ++step) {
    findFarthest();
    center += (farthest - center) / double(step + 1);
  }
  return {center, findFarthest()};
}

namespace {

std::vector<glm::dvec3> distinctPoints(const Surface& surface) {
  std::vector<glm::dvec3> points = surface.positions;
  const auto key = [](const glm::dvec3& p) { return std::tie(p.x, p.y, p.z); };
  std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

glm::dvec3 meanOf(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum{0.0};
  for (const glm::dvec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

// Least deviation that float positions and half a dozen decimals in a file may have, relative to the size.
constexpr double kFitTolerance = 1e-4;

std::optional<AnalyticSurface> fitSphere(const std::vector<glm::dvec3>& points, const glm::dvec3& mean) {
  double radius = 0.0;
  for (const glm::dvec3& point : points) radius += glm::distance(point, mean) / double(points.size());
  for (const glm::dvec3& point : points) {
    if (std::abs(glm::distance(point, mean) - radius) > kFitTolerance * radius) return std::nullopt;
  }
  return sphereSurface(mean, radius);
}

std::optional<AnalyticSurface> fitTorus(const std::vector<glm::dvec3>& points, const glm::dvec3& mean,
                                        int axis) {
  // ρ² + z² = 2 R ρ + (r² - R²): least squares for the straight line through (ρ, ρ² + z²).
  double n = 0, sumX = 0, sumY = 0, sumXX = 0, sumXY = 0;
  const auto radial = [&](const glm::dvec3& point) {
    const glm::dvec3 d = point - mean;
    return std::hypot(d[(axis + 1) % 3], d[(axis + 2) % 3]);
  };
  for (const glm::dvec3& point : points) {
    const double x = radial(point), y = glm::dot(point - mean, point - mean);
    n += 1, sumX += x, sumY += y, sumXX += x * x, sumXY += x * y;
  }
  const double slope = (n * sumXY - sumX * sumY) / (n * sumXX - sumX * sumX);
  const double ring = slope / 2, tube2 = (sumY - slope * sumX) / n + ring * ring;
  if (!(tube2 > 0) || !(ring > 0)) return std::nullopt;
  const double tube = std::sqrt(tube2);
  if (tube > 0.99 * ring) return std::nullopt;
  for (const glm::dvec3& point : points) {
    const double off = std::hypot(radial(point) - ring, (point - mean)[axis]) - tube;
    if (!(std::abs(off) <= kFitTolerance * ring)) return std::nullopt;
  }
  return torusSurface(mean, ring, tube, axis);
}

std::optional<AnalyticSurface> fitKnot(const std::vector<glm::dvec3>& points) {
  for (const glm::dvec3& point : points) {
    double nearest = 1e30;
    constexpr int kSamples = 2000;
    for (int i = 0; i < kSamples; ++i) {
      nearest = std::min(nearest, glm::distance(point, knotFrame(2 * kPi * i / kSamples).point));
    }
    if (std::abs(nearest - kKnotTube) > 1e-3) return std::nullopt;
  }
  return knotSurface(glm::dvec3(0.0), 1.0);
}

// All points but the tip and the middle of the base lie on one circle across the axis.
std::optional<AnalyticSurface> fitCone(const std::vector<glm::dvec3>& points, int axis, double up) {
  const auto height = [&](const glm::dvec3& point) { return up * point[axis]; };
  const glm::dvec3 apex = *std::max_element(
      points.begin(), points.end(), [&](const auto& a, const auto& b) { return height(a) < height(b); });
  std::vector<glm::dvec3> ring;
  for (const glm::dvec3& point : points) {
    glm::dvec3 across = point - apex;
    across[axis] = 0.0;
    if (glm::length(across) > kFitTolerance) ring.push_back(point);
  }
  if (ring.size() < 3) return std::nullopt;
  const glm::dvec3 base = meanOf(ring);
  const double radius = glm::distance(ring.front(), base);
  for (const glm::dvec3& point : ring) {
    if (std::abs(glm::distance(point, base) - radius) > kFitTolerance * radius) return std::nullopt;
    if (std::abs(height(point) - height(base)) > kFitTolerance * radius) return std::nullopt;
  }
  return coneSurface(base, apex, radius);
}

}  // namespace

AnalyticSurface recognizeAnalytic(const Surface& coarse) {
  const std::vector<glm::dvec3> points = distinctPoints(coarse);
  require(points.size() >= 4, "no analytic surface goes through fewer than four points");
  const glm::dvec3 mean = meanOf(points);
  if (auto sphere = fitSphere(points, mean)) return *std::move(sphere);
  for (int axis = 0; axis < 3; ++axis) {
    if (auto torus = fitTorus(points, mean, axis)) return *std::move(torus);
    for (const double up : {1.0, -1.0}) {
      if (auto cone = fitCone(points, axis, up)) return *std::move(cone);
    }
  }
  if (auto knot = fitKnot(points)) return *std::move(knot);
  require(false,
          "the vertices lie on no sphere, torus, knot tube or cone that limn knows: name a truth mesh");
  return {};
}

}  // namespace limn::measure
