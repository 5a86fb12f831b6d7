// A lit square in perspective, turned a little, written as a PPM image to standard output.
#include <cstdio>
#include <vector>

#include "raster/raster.h"

int main() {
  using namespace limn::raster;
  constexpr int kWidth = 320, kHeight = 200;
  const std::vector<glm::vec3> positions{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<glm::vec3> normals(4, {0, 0, 1});
  const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  const std::vector<Part> parts{{.firstTriangle = 0, .triangleCount = 2, .material = 0}};
  const Geometry geometry({positions, normals, {}, {}, {}}, indices, parts);  // once per mesh

  std::vector<Draw> draws(1);
  draws[0].geometry = &geometry;
  draws[0].modelToView = {0.8F, 0, -0.6F, 0, 0, 1, 0, 0, 0.6F, 0, 0.8F, 0, 0, 0, -4, 1};  // by columns
  const std::vector<Material> materials(1);
  const std::vector<Light> lights(1);
  Frame frame;
  frame.projection = {true, 300, 300, 0.1F, 100, kWidth, kHeight};  // see raster/base/projection.h
  frame.draws = draws, frame.materials = materials, frame.lights = lights;
  frame.background = {0.02F, 0.02F, 0.05F, 1};

  std::vector<std::uint8_t> rgba(4UL * kWidth * kHeight);
  Target target;
  target.rgba = rgba.data(), target.rgbaStride = 4UL * kWidth;
  Renderer renderer(2);          // once: two threads
  renderer.draw(frame, target);  // per frame

  std::printf("P6 %d %d 255\n", kWidth, kHeight);
  for (std::size_t i = 0; i < rgba.size(); i += 4) std::fwrite(&rgba[i], 1, 3, stdout);
}
