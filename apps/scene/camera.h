// Cameras: automatic framing, explicit ones, the file's own; and the matrices that the two modules want.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "apps/scene/pose.h"
#include "raster/base/projection.h"

namespace limn::scene {

/// A camera ready for drawing.
struct CameraView {
  glm::dmat4 worldToView{1.0};  ///< rigid; the eye at the origin looks along -z
  Projection projection;
};

/// What an explicit or automatic perspective (or, with orthoHeight > 0, orthographic) camera is made from.
struct LookAt {
  glm::dvec3 eye{0.0, 0.0, 1.0}, target{0.0}, up{0.0, 1.0, 0.0};
  double fovDegrees = 30.0;  ///< vertical, (0, 180)
  double orthoHeight = 0.0;  ///< > 0: orthographic, this many world units high
};

/// The camera that fits `bounds` into the smaller side of the window with a margin of 5 %, seen from
/// azimuth/elevation (degrees; azimuth 0 looks along -z, positive turns the eye to the right), magnified by `zoom`.
/// A sphere fits exactly in perspective: the distance is radius / sin(half angle).
LookAt frameSphere(const Sphere& bounds, int width, int height, double azimuthDegrees, double elevationDegrees,
                   double zoom, double fovDegrees, double orthoHeight);

/// Matrices for a window. Near and far planes just enclose `bounds` (near at least 1/4096 of far where the eye is inside).
/// Throws std::invalid_argument for eye = target, up along the line of sight, a field of view outside (0, 180), sizes
/// outside 1 … 16384, or numbers that are not finite.
CameraView makeCamera(const LookAt& lookAt, const Sphere& bounds, int width, int height);

/// The same from a camera of the file at `nodeToWorld`.
CameraView makeCamera(const Camera& camera, const glm::dmat4& nodeToWorld, const Sphere& bounds, int width, int height);

}  // namespace limn::scene
