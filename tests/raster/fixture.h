// Frames and targets for the rasterizer's tests.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "raster/raster.h"

namespace limn::raster::test {

struct Picture {
  int width, height;
  std::vector<std::uint8_t> rgba;
  std::vector<float> depth;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> ids;

  Picture(int w, int h)
      : width(w), height(h), rgba(pixels() * 4), depth(pixels()), normals(pixels()), ids(pixels()) {}
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  Target target() {
    const auto w = static_cast<std::size_t>(width);
    return {rgba.data(), 4 * w, depth.data(), w, normals.data(), w, ids.data(), w};
  }
  bool operator==(const Picture&) const = default;
};

/// Triangles over vertices of their own, normals +z.
struct Soup {
  std::vector<glm::vec3> positions, normals;
  std::vector<std::uint32_t> indices;

  std::uint32_t vertex(const glm::vec3& p, const glm::vec3& n = {0.0F, 0.0F, 1.0F}) {
    positions.push_back(p);
    normals.push_back(n);
    return static_cast<std::uint32_t>(positions.size() - 1);
  }
  void triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    for (const glm::vec3& p : {a, b, c}) indices.push_back(vertex(p));
  }
  Geometry geometry() const {
    const Part part{0, static_cast<std::uint32_t>(indices.size() / 3), 0};
    Vertices v;
    v.positions = positions;
    v.normals = normals;
    return Geometry(v, indices, std::span(&part, 1));
  }
};

/// One pixel per unit: view (x, y) is at pixel (width/2 + x, height/2 - y); depths 0 … 1000.
inline Projection pixelProjection(int width, int height) {
  return {false, 1.0F, 1.0F, 0.0F, 1000.0F, width, height};
}

/// A frame of one draw with one material and one light of the peer's scene.
struct Scene {
  std::vector<Draw> draws = std::vector<Draw>(1);
  std::vector<Material> materials = std::vector<Material>(1);
  std::vector<Light> lights = std::vector<Light>(1);
  Frame frame;

  explicit Scene(const Projection& projection) { frame.projection = projection; }
  Picture draw(Renderer& renderer, Statistics* statistics = nullptr) {
    frame.draws = draws;
    frame.materials = materials;
    frame.lights = lights;
    Picture picture(frame.projection.width, frame.projection.height);
    renderer.draw(frame, picture.target(), statistics);
    return picture;
  }
};

}  // namespace limn::raster::test
