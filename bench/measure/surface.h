// Triangles in world space, in double precision: what masks are drawn from.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/scene/pose.h"

namespace limn::measure {

struct Surface {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> indices;  ///< three per triangle

  std::size_t triangleCount() const { return indices.size() / 3; }
};

/// The smallest sphere around the points, its radius at most 1 % too large and never too small.
scene::Sphere boundingSphere(const Surface& surface);

/// Tessellations of analytic surfaces. `error` bounds the distance of every point of the tessellation from
/// the surface.
struct AnalyticSurface {
  Surface surface;
  double error = 0.0;  ///< world units
};
AnalyticSurface sphereSurface(const glm::dvec3& center, double radius);
/// Tube of radius `tube` along the circle of radius `ring` around `axis` (0, 1 or 2).
AnalyticSurface torusSurface(const glm::dvec3& center, double ring, double tube, int axis);
/// Tube of radius 0.55 `scale` along `scale` (sin s + 2 sin 2s, cos s - 2 cos 2s, -sin 3s) about `center`.
AnalyticSurface knotSurface(const glm::dvec3& center, double scale);
/// Cone with its base circle at `base` and its tip at `apex`.
AnalyticSurface coneSurface(const glm::dvec3& base, const glm::dvec3& apex, double radius);

/// Finds the analytic surface on which all vertices of a coarse mesh lie: sphere, torus, knot tube or cone.
/// Throws std::invalid_argument where there is none.
AnalyticSurface recognizeAnalytic(const Surface& coarse);

}  // namespace limn::measure
