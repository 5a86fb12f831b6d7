// One triangle in pixels.
#include <array>
#include <cstdio>
#include <vector>

#include "raster/raster.h"

int main() {
  using namespace limn;
  const std::array<glm::vec3, 3> positions = {{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
  const std::array<glm::vec3, 3> normals = {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};
  const std::array<std::uint32_t, 3> indices = {0, 1, 2};
  const std::array<raster::Part, 1> parts = {{{0, 1, 0}}};
  raster::Vertices vertices;
  vertices.positions = positions;
  vertices.normals = normals;
  const raster::Geometry geometry(vertices, indices, parts);
  const std::array<raster::Material, 1> materials;
  const std::array<raster::Light, 1> lights;
  std::array<raster::Draw, 1> draws;
  draws[0].geometry = &geometry;
  draws[0].modelToView[3].z = -4;
  raster::Frame frame;
  frame.projection.pixelsX = frame.projection.pixelsY = 100;
  frame.projection.nearPlane = 1;
  frame.projection.farPlane = 10;
  frame.projection.width = frame.projection.height = 64;
  frame.draws = draws;
  frame.materials = materials;
  frame.lights = lights;
  std::vector<std::uint8_t> pixels(64 * 64 * 4);
  raster::Target target;
  target.rgba = pixels.data();
  target.rgbaStride = 64 * 4;
  raster::Renderer(2).draw(frame, target);
  const std::uint8_t alpha = pixels[4 * (32 * 64 + 32) + 3];
  std::printf("alpha %d in the middle, %d in the corner\n", alpha, pixels[3]);
  return alpha == 255 && pixels[3] == 0 ? 0 : 1;
}
