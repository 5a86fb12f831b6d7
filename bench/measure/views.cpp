#include "bench/measure/views.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

// Rodrigues' rotation about a unit axis.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double radians) {
  const SinCos angle = sinCos(radians);
  return v * angle.cos + glm::cross(axis, v) * angle.sin + axis * (glm::dot(axis, v) * (1.0 - angle.cos));
}

// Steele, Lea & Flood, "Fast splittable pseudorandom number generators", 2014 (SplitMix64).
double nextUniform(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

std::vector<glm::dvec3> standardDirections() {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, 3.0));
  std::vector<glm::dvec3> directions;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        directions.push_back(turned(glm::normalize(glm::dvec3(x, y, z)), axis, 0.1));
      }
    }
  }
  return directions;
}

std::vector<glm::dvec3> randomDirections(std::uint64_t seed, int count) {
  std::vector<glm::dvec3> directions;
  for (std::uint64_t state = seed; directions.size() < static_cast<std::size_t>(count);) {
    glm::dvec3 point;
    for (int i = 0; i < 3; ++i) point[i] = 2.0 * nextUniform(state) - 1.0;
    const double length2 = glm::dot(point, point);
    if (length2 > 0.01 && length2 <= 1.0) directions.push_back(point / std::sqrt(length2));
  }
  return directions;
}

scene::CameraView outlineCamera(const scene::Sphere& bounds, const glm::dvec3& direction, int size) {
  const double halfHeight = tangent(15.0 * kPi / 180.0);  // of the window at distance 1
  const double tangentOfSphere = 0.95 * halfHeight;
  const double distance = bounds.radius * std::sqrt(1.0 + 1.0 / (tangentOfSphere * tangentOfSphere));
  const glm::dvec3 eye = bounds.center + direction * distance;
  const glm::dvec3 up = std::abs(direction.y) > 0.999 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(up, direction));
  const glm::dvec3 above = glm::cross(direction, right);

  scene::CameraView camera;
  for (int i = 0; i < 3; ++i) {
    camera.worldToView[i] = glm::dvec4(right[i], above[i], direction[i], 0.0);
  }
  camera.worldToView[3] =
      glm::dvec4(-glm::dot(right, eye), -glm::dot(above, eye), -glm::dot(direction, eye), 1.0);
  camera.projection.pixelsX = camera.projection.pixelsY = static_cast<float>(size / 2.0 / halfHeight);
  camera.projection.nearPlane = static_cast<float>((distance - bounds.radius) * 0.9);
  camera.projection.farPlane = static_cast<float>((distance + bounds.radius) * 1.1);
  camera.projection.width = camera.projection.height = size;
  return camera;
}

}  // namespace limn::measure
