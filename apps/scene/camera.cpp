// Based on: the look-at matrix of OpenGL (GLU 1.3, gluLookAt) and the camera of glTF 2.0, section 3.10.
// Differs in: everything is computed in double precision by limn's own elementary functions, for the same
// bits on every machine; near and far planes follow the scene.
#include "apps/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "raster/base/check.h"
#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

/// A scene may reach to 1e15, and the eye that frames it stands a few times or, with a narrow field of view, hundreds of
/// times farther away. Squares of such numbers are floats still.
constexpr double kLargestCoordinate = 1e18;
constexpr double kSmallestRadius =
    1e-15;  // below it a scene is framed as a point: squares of 1/depth would overflow
/// Edge curves leave the coarse mesh by at most half its bounding radius (cubic control points lie within a
/// third of an edge from their chord), so this much around its centre is never clipped.
constexpr double kDepthSlack = 1.5;
constexpr double kDeepestRatio = 4096.0;   // far to near where the eye is inside the scene
constexpr double kLeastDepthRange = 1e-6;  // of the near plane: a difference that floats still show

bool isLegal(double x) {
  return std::abs(x) <= kLargestCoordinate;
}  // false for NaN too
bool isLegal(const glm::dvec3& v) {
  return isLegal(v.x) && isLegal(v.y) && isLegal(v.z);
}

void requireWindow(int width, int height) {
  require(width >= 1 && width <= 16384 && height >= 1 && height <= 16384,
          "the window must be 1 to 16384 pixels wide and high");
}

/// Tangent of half the vertical field of view.
double halfTangent(double fovDegrees) {
  require(fovDegrees > 0.0 && fovDegrees < 180.0, "the field of view must be between 0 and 180 degrees");
  const SinCos half = sinCosDegrees(0.5 * fovDegrees);
  return half.sin / half.cos;
}

double usableRadius(const Sphere& bounds) {
  return bounds.radius >= kSmallestRadius ? bounds.radius : 1.0;
}

/// World to view for an orthonormal basis at `eye`: `right` and `up` as the window shows them, `back` towards
/// the viewer.
glm::dmat4 viewMatrix(const glm::dvec3& right, const glm::dvec3& up, const glm::dvec3& back,
                      const glm::dvec3& eye) {
  glm::dmat4 m(1.0);
  for (int axis = 0; axis < 3; ++axis) m[axis] = glm::dvec4(right[axis], up[axis], back[axis], 0.0);
  m[3] = glm::dvec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1.0);
  return m;
}

/// Near and far planes around `bounds`, within [atLeast, atMost] where a file says so.
void setDepthRange(const Sphere& bounds, const glm::dmat4& worldToView, double atLeast, double atMost,
                   Projection& projection) {
  const double depth = -(worldToView * glm::dvec4(bounds.center, 1.0)).z;
  const double reach = kDepthSlack * std::max(usableRadius(bounds), 1e-6 * std::abs(depth));
  double farPlane = std::min(depth + reach, atMost);
  double nearPlane = depth - reach;
  if (projection.perspective) {
    if (!(farPlane > kSmallestRadius)) farPlane = reach;  // all of it behind the eye: any range will do
    nearPlane = std::max(nearPlane, farPlane / kDeepestRatio);
  }
  if (atLeast > 0.0) nearPlane = std::max(nearPlane, atLeast);
  if (!(nearPlane < farPlane)) farPlane = nearPlane + reach;  // all of it before the file's near plane
  farPlane = std::max(farPlane, nearPlane + kLeastDepthRange * std::abs(nearPlane));
  projection.nearPlane = static_cast<float>(nearPlane);
  projection.farPlane = static_cast<float>(farPlane);
}

/// Square pixels, so many per unit at w = 1.
void setScale(double pixelsPerUnit, Projection& projection) {
  const float pixels = static_cast<float>(pixelsPerUnit);
  require(pixels > 1e-30f && pixels < 1e30f, "the camera sees too much or too little");
  projection.pixelsX = projection.pixelsY = pixels;
}

Projection windowOf(int width, int height, bool perspective) {
  requireWindow(width, height);
  Projection projection;
  projection.perspective = perspective;
  projection.width = width;
  projection.height = height;
  return projection;
}

}  // namespace

LookAt frameSphere(const Sphere& bounds, int width, int height, double azimuthDegrees,
                   double elevationDegrees, double zoom, double fovDegrees, double orthoHeight) {
  requireWindow(width, height);
  require(isLegal(azimuthDegrees) && isLegal(elevationDegrees), "azimuth and elevation must be finite");
  require(zoom > 0.0 && isLegal(zoom), "zoom must be a finite number above 0");
  require(isLegal(orthoHeight), "the orthographic height must be finite");
  require(isLegal(bounds.center) && isLegal(bounds.radius), "the scene must not reach farther than 1e18");

  const double radius = usableRadius(bounds);
  const double tangentOfHalf = halfTangent(fovDegrees);
  // The sphere's outline may reach this share of the window's half height from the centre.
  const double share = kFramedShare * std::min(width, height) / height;
  // A tangent ray at angle a from the axis touches the sphere at distance radius / sin a.
  const double tangentOfRay = share * tangentOfHalf;
  const double distance = radius * std::sqrt(1.0 + 1.0 / (tangentOfRay * tangentOfRay));

  const SinCos azimuth = sinCosDegrees(azimuthDegrees);
  const SinCos elevation = sinCosDegrees(elevationDegrees);
  const glm::dvec3 towardsEye(azimuth.sin * elevation.cos, elevation.sin, azimuth.cos * elevation.cos);
  LookAt lookAt;
  lookAt.target = bounds.center;
  lookAt.eye = bounds.center + distance * towardsEye;
  // The direction of growing elevation: never along the line of sight, straight above and below included.
  lookAt.up = glm::dvec3(-azimuth.sin * elevation.sin, elevation.cos, -azimuth.cos * elevation.sin);
  lookAt.fovDegrees = zoom == 1.0 ? fovDegrees : 2.0 * arcTangent2(tangentOfHalf / zoom, 1.0) * (180.0 / kPi);
  if (orthoHeight < 0.0) orthoHeight = 2.0 * radius / share;
  lookAt.orthoHeight = orthoHeight / zoom;
  return lookAt;
}

CameraView makeCamera(const LookAt& lookAt, const Sphere& bounds, int width, int height) {
  require(isLegal(lookAt.eye) && isLegal(lookAt.target) && isLegal(lookAt.up),
          "camera coordinates must be finite and at most 1e18");
  require(isLegal(lookAt.orthoHeight) && lookAt.orthoHeight >= 0.0,
          "the orthographic height must be finite and not negative");
  const glm::dvec3 backwards = lookAt.eye - lookAt.target;
  const double distance = glm::length(backwards);
  require(distance > 1e-15 * glm::length(lookAt.target) && distance > 0.0,
          "eye and target are the same point");
  const glm::dvec3 back = backwards / distance;
  const double upLength = glm::length(lookAt.up);
  require(upLength > 0.0, "the up vector is zero");
  const glm::dvec3 sideways = glm::cross(lookAt.up / upLength, back);
  const double sine = glm::length(sideways);
  require(sine > 1e-9, "the up vector lies along the line of sight");
  const glm::dvec3 right = sideways / sine;

  CameraView view;
  view.worldToView = viewMatrix(right, glm::cross(back, right), back, lookAt.eye);
  view.projection = windowOf(width, height, lookAt.orthoHeight == 0.0);
  const double halfHeight =
      view.projection.perspective ? halfTangent(lookAt.fovDegrees) : 0.5 * lookAt.orthoHeight;
  setScale(0.5 * height / halfHeight, view.projection);
  setDepthRange(bounds, view.worldToView, 0.0, std::numeric_limits<double>::infinity(), view.projection);
  return view;
}

CameraView makeCamera(const Camera& camera, const glm::dmat4& nodeToWorld, const Sphere& bounds, int width,
                      int height) {
  const glm::dvec3 eye(nodeToWorld[3]);
  require(isLegal(eye), "the camera's position must be finite and at most 1e18");
  const double backLength = glm::length(glm::dvec3(nodeToWorld[2]));
  require(backLength > 0.0 && isLegal(backLength),
          "the camera's node has no direction: its scale is zero or beyond 1e18");
  const glm::dvec3 back = glm::dvec3(nodeToWorld[2]) / backLength;
  const glm::dvec3 upwards = glm::dvec3(nodeToWorld[1]) - back * glm::dot(back, glm::dvec3(nodeToWorld[1]));
  const double upLength = glm::length(upwards);
  require(upLength > 0.0 && isLegal(upLength),
          "the camera's node has no upright direction: its scale is zero or beyond 1e18");
  const glm::dvec3 up = upwards / upLength;

  CameraView view;
  view.worldToView = viewMatrix(glm::cross(up, back), up, back, eye);
  view.projection = windowOf(width, height, camera.perspective);
  double halfWidth = camera.xmag, halfHeight = camera.ymag;
  if (camera.perspective) {
    require(camera.yfov > 0.0 && camera.yfov < kPi,
            "the camera's field of view must be between 0 and 180 degrees");
    halfHeight = tangent(0.5 * camera.yfov);
    halfWidth = halfHeight * camera.aspect;  // 0: the window's
  }
  // A negative magnification is a mirror in the letter of the format; its size is what counts here.
  halfWidth = std::abs(halfWidth), halfHeight = std::abs(halfHeight);
  const double vertical = 0.5 * height / halfHeight;
  setScale(halfWidth > 0.0 ? std::min(vertical, 0.5 * width / halfWidth) : vertical, view.projection);
  setDepthRange(bounds, view.worldToView, camera.nearPlane, camera.farPlane, view.projection);
  return view;
}

glm::dmat4 turnAbout(const glm::dvec3& point, const glm::dvec3& axis, double degrees) {
  const double length = glm::length(axis);
  require(length > 0.0 && isLegal(length), "the axis must be finite and not zero");
  const glm::dvec3 a = axis / length;
  const SinCos angle = sinCosDegrees(degrees);
  // Rodrigues' formula, by columns.
  glm::dmat3 rotation;
  for (int column = 0; column < 3; ++column) {
    glm::dvec3 e(0.0);
    e[column] = 1.0;
    rotation[column] = e * angle.cos + glm::cross(a, e) * angle.sin + a * (a[column] * (1.0 - angle.cos));
  }
  glm::dmat4 turn(rotation);
  turn[3] = glm::dvec4(point - rotation * point, 1.0);
  return turn;
}

}  // namespace limn::scene
