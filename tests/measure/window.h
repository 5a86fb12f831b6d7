// Shapes drawn straight into a mask: a camera whose view plane z = -1 is the window in pixels, y down.
#pragma once

#include <cmath>
#include <vector>

#include "bench/measure/mask.h"

namespace limn::measure {

inline scene::CameraView windowCamera(int size) {
  scene::CameraView camera;
  camera.projection = {true, 1.0f, 1.0f, 0.01f, 100.0f, size, size};
  return camera;
}

/// A convex polygon as a fan; `points` in pixels.
inline Surface convexPolygon(const std::vector<glm::dvec2>& points, int size) {
  Surface surface;
  for (const glm::dvec2& p : points) surface.positions.emplace_back(p.x - size / 2.0, size / 2.0 - p.y, -1.0);
  for (std::uint32_t i = 2; i < points.size(); ++i)
    surface.indices.insert(surface.indices.end(), {0, i - 1, i});
  return surface;
}

inline std::vector<glm::dvec2> regularPolygon(glm::dvec2 center, double radius, int sides,
                                              double turn = 0.1) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < sides; ++i) {
    const double angle = turn + 2 * 3.14159265358979323846 * i / sides;
    points.push_back(center + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

inline Mask drawn(const Surface& surface, int size) {
  std::vector<SampleTriangle> triangles;
  project(surface, windowCamera(size), triangles);
  Mask mask(size, size);
  mask.draw(triangles);
  return mask;
}

inline Mask drawnPolygon(const std::vector<glm::dvec2>& points, int size) {
  return drawn(convexPolygon(points, size), size);
}

}  // namespace limn::measure
