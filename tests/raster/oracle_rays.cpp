#include "tests/raster/oracle_rays.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace limn::test {
namespace {

struct Ray {
  glm::dvec3 origin, direction;  ///< direction.z = -1, so that the ray's parameter is the depth
};

Ray rayThrough(const Projection& projection, double x, double y) {
  const glm::dvec2 at((x - projection.width / 2.0) / projection.pixelsX,
                      (projection.height / 2.0 - y) / projection.pixelsY);
  if (projection.perspective) return {glm::dvec3(0.0), glm::dvec3(at, -1.0)};
  return {glm::dvec3(at, 0.0), glm::dvec3(0.0, 0.0, -1.0)};
}

std::optional<Hit> intersect(const ViewTriangle& triangle, const Ray& ray, const Projection& projection) {
  const glm::dvec3 e1 = triangle.corners[1] - triangle.corners[0];
  const glm::dvec3 e2 = triangle.corners[2] - triangle.corners[0];
  const glm::dvec3 p = glm::cross(ray.direction, e2);
  const double determinant = glm::dot(e1, p);  // > 0: the ray meets the counter-clockwise side
  if (determinant == 0.0) return {};
  const bool front = (determinant > 0.0) != triangle.reflected;
  if (!front && !triangle.doubleSided) return {};
  const glm::dvec3 s = ray.origin - triangle.corners[0];
  const double u = glm::dot(s, p) / determinant;
  if (u < 0.0 || u > 1.0) return {};
  const glm::dvec3 q = glm::cross(s, e1);
  const double v = glm::dot(ray.direction, q) / determinant;
  if (v < 0.0 || u + v > 1.0) return {};
  const double depth = glm::dot(e2, q) / determinant;
  if (depth < projection.nearPlane || depth > projection.farPlane) return {};
  const std::array<double, 3> weights{1.0 - u - v, u, v};
  Hit hit{triangle.id, depth, glm::dvec3(0.0), glm::dvec4(0.0)};
  for (int k = 0; k < 3; ++k) {
    hit.normal += weights[k] * triangle.normals[k];
    hit.color += weights[k] * triangle.colors[k];
  }
  hit.normal = glm::normalize(front ? hit.normal : -hit.normal);
  return hit;
}

}  // namespace

void place(const Soup& soup, const glm::mat4& modelToView, std::uint32_t firstId, bool doubleSided,
           std::vector<ViewTriangle>& triangles) {
  const glm::dmat4 matrix(modelToView);
  const glm::dmat3 linear(matrix);
  const glm::dmat3 forNormals = glm::transpose(glm::inverse(linear));
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
    ViewTriangle triangle;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = soup.indices[3 * t + k];
      triangle.corners[k] = glm::dvec3(matrix * glm::dvec4(glm::dvec3(soup.positions[vertex]), 1.0));
      triangle.normals[k] = glm::normalize(forNormals * glm::dvec3(soup.normals[vertex]));
      triangle.colors[k] = soup.colors.empty() ? glm::dvec4(1.0) : glm::dvec4(soup.colors[vertex]);
    }
    triangle.id = firstId + static_cast<std::uint32_t>(t);
    triangle.reflected = glm::determinant(linear) < 0.0;
    triangle.doubleSided = doubleSided;
    triangles.push_back(triangle);
  }
}

std::optional<Hit> castRay(std::span<const ViewTriangle> triangles, const Projection& projection, double x,
                           double y) {
  const Ray ray = rayThrough(projection, x, y);
  std::optional<Hit> nearest;
  for (const ViewTriangle& triangle : triangles) {
    const std::optional<Hit> hit = intersect(triangle, ray, projection);
    if (hit && (!nearest || hit->depth < nearest->depth)) nearest = hit;
  }
  return nearest;
}

}  // namespace limn::test
