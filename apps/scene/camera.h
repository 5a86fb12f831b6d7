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

/// Share of the window's smaller side that a framed sphere fills: a margin of 5 %.
inline constexpr double kFramedShare = 0.95;

/// The camera that fits `bounds` into the smaller side of the window with a margin of 5 %, seen from
/// azimuth/elevation (degrees; azimuth 0 looks along -z, positive turns the eye to the right), magnified by
/// `zoom`. A sphere fits exactly in perspective: the distance is radius / sin(half angle). Zoom narrows the
/// field of view and leaves the eye where it is. `orthoHeight`: 0 = perspective; > 0 = orthographic, that
/// many world units high at zoom 1; < 0 = orthographic, fitted. A sphere of radius 0 is framed as one of
/// radius 1. Throws std::invalid_argument for numbers that are not finite, zoom <= 0, a field of view outside
/// (0, 180) and sizes outside 1 … 16384.
LookAt frameSphere(const Sphere& bounds, int width, int height, double azimuthDegrees,
                   double elevationDegrees, double zoom, double fovDegrees, double orthoHeight);

/// Matrices for a window. Near and far planes enclose `bounds`, half its radius to spare on either side
/// because curved surfaces rise above their coarse mesh (near at least 1/4096 of far where the eye is
/// inside). Throws std::invalid_argument for eye = target, up along the line of sight, a field of view
/// outside (0, 180), sizes outside 1 … 16384, or numbers that are not finite or beyond 1e18.
CameraView makeCamera(const LookAt& lookAt, const Sphere& bounds, int width, int height);

/// The same from a camera of the file at `nodeToWorld`, whose scale and shear have no effect. Pixels are
/// square: the window shows all of what the file's camera sees and, where its shape differs from the camera's
/// aspect ratio, more at the sides or at top and bottom.
CameraView makeCamera(const Camera& camera, const glm::dmat4& nodeToWorld, const Sphere& bounds, int width,
                      int height);

/// The rotation by `degrees` (counter-clockwise seen against the axis) about the line through `point` along
/// `axis`. Throws std::invalid_argument for a zero axis.
glm::dmat4 turnAbout(const glm::dvec3& point, const glm::dvec3& axis, double degrees);

}  // namespace limn::scene
