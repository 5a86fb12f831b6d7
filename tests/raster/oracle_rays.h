// What a pixel must show, by casting a ray through it: the judge of perspective correctness and of clipping.
//
// Based on: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools
// 2 (1997), in double precision. A ray needs no clipping: a hit counts when its depth lies between the near
// and the far plane.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "raster/raster.h"
#include "tests/raster/oracle_scene.h"

namespace limn::test {

/// A triangle in view space.
struct ViewTriangle {
  std::array<glm::dvec3, 3> corners, normals;
  std::array<glm::dvec4, 3> colors;
  std::uint32_t id = 0;
  bool reflected = false;    ///< by its instance's matrix: front faces run clockwise
  bool doubleSided = false;  ///< back faces count, with their normals turned round
};

struct Hit {
  std::uint32_t id = 0;
  double depth = 0.0;      ///< along -z
  glm::dvec3 normal{0.0};  ///< unit
  glm::dvec4 color{0.0};
};

/// Adds `soup` placed by `modelToView`, ids from `firstId`. Normals go by the inverse transpose and are made unit.
void place(const Soup& soup, const glm::mat4& modelToView, std::uint32_t firstId, bool doubleSided,
           std::vector<ViewTriangle>& triangles);

/// The nearest hit of the ray through the point (x, y) of the window, in pixels from its upper left corner.
std::optional<Hit> castRay(std::span<const ViewTriangle> triangles, const Projection& projection, double x,
                           double y);

}  // namespace limn::test
