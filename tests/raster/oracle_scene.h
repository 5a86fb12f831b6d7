// Small scenes for the oracle tests, and pictures with every plane that the rasterizer can write.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <random>
#include <span>
#include <vector>

#include "raster/raster.h"

namespace limn::test {

using Random = std::mt19937;
/// In [low, high).
double uniform(Random& random, double low, double high);

/// Triangles in plain arrays, as a caller of the rasterizer holds them.
struct Soup {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> colors;  ///< empty or one per vertex
  std::vector<std::uint32_t> indices;

  std::size_t triangleCount() const { return indices.size() / 3; }
  raster::Vertices vertices() const { return {positions, normals, {}, colors, {}}; }
  raster::Geometry geometry() const;  ///< all in one part, material 0
};

/// Closed, counter-clockwise seen from outside, with the normals of the surface: a sphere of radius 1 cut
/// into `rings` · `sides` quads (triangles at the poles), and a torus of radii 1 and `tube` around the z
/// axis.
Soup sphere(int rings, int sides);
Soup torus(int along, int around, float tube);
/// Every triangle turned round.
Soup insideOut(Soup soup);

/// All planes of one frame.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
  std::vector<float> depth;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> ids;

  bool operator==(const Picture& other) const;  ///< the same bytes in every plane
};

Picture render(raster::Renderer& renderer, const raster::Frame& frame);

/// The window as the sub-pixel grid sees it: one unit of view space is one pixel, the window's centre is the
/// axis.
Projection pixelProjection(int width, int height, bool perspective);
/// A window `degrees` high.
Projection perspectiveProjection(int width, int height, double degrees, float nearPlane, float farPlane);

}  // namespace limn::test
