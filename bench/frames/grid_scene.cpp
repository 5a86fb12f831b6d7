#include "bench/frames/grid_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "apps/scene/load.h"
#include "apps/scene/pose.h"
#include "raster/base/check.h"
#include "raster/base/elementary.h"

namespace limn::bench {
namespace {

glm::dmat3 turnAboutX(double radians) {
  const SinCos a = sinCos(radians);
  return {{1, 0, 0}, {0, a.cos, a.sin}, {0, -a.sin, a.cos}};
}
glm::dmat3 turnAboutY(double radians) {
  const SinCos a = sinCos(radians);
  return {{a.cos, 0, -a.sin}, {0, 1, 0}, {a.sin, 0, a.cos}};
}

std::string nameForLoading(const std::string& model) {
  const bool known = model.starts_with("builtin:") || model.ends_with(".glb") || model.ends_with(".gltf");
  return known || std::filesystem::exists(model) ? model : "builtin:" + model;
}

// Appends an instance of the scene, turned round where its transform reflects it.
void append(const scene::Mesh& mesh, const glm::dmat4& toWorld, scene::Mesh& all,
            std::vector<glm::dvec3>& positions) {
  const glm::dmat3 linear(toWorld);
  const bool reflected = glm::determinant(linear) < 0.0;
  const glm::dmat3 forNormals = glm::transpose(glm::inverse(linear));
  const auto first = static_cast<std::uint32_t>(positions.size());
  for (const glm::vec3& p : mesh.positions) positions.emplace_back(toWorld * glm::dvec4(p, 1.0));
  for (const glm::vec3& n : mesh.normals) {
    all.normals.push_back(glm::vec3(glm::normalize(forNormals * glm::dvec3(n))));
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t second = reflected ? 2 : 1;
    for (const std::size_t corner : {i, i + second, i + 3 - second}) {
      all.indices.push_back(first + mesh.indices[corner]);
    }
  }
}

}  // namespace

Grid::Grid(int copies, int width, int height) : copies_(copies) {
  require(copies >= 1, "a grid has at least one copy");
  aspect_ = static_cast<double>(width) / height;
  columns_ = copies == 1 ? 1 : static_cast<int>(std::ceil(std::sqrt(copies * aspect_) - 1e-3));
  rows_ = (copies + columns_ - 1) / columns_;
  cellWidth_ = 2.0 * aspect_ / columns_;
  cellHeight_ = 2.0 / rows_;
  distance_ = 1.0 / tangent(kPi / 12.0);
  projection_.perspective = true;
  projection_.pixelsX = projection_.pixelsY = static_cast<float>(distance_ * height / 2.0);
  projection_.nearPlane = static_cast<float>(distance_ - 1.6);
  projection_.farPlane = static_cast<float>(distance_ + 1.6);
  projection_.width = width;
  projection_.height = height;
}

glm::dmat4 Grid::place(int copy, int view, int views, double scale) const {
  const int column = copy % columns_, row = copy / columns_;
  const glm::dmat3 turn =
      turnAboutY(2.0 * kPi * view / views) * turnAboutY(2.399963 * copy) * turnAboutX(0.7 * copy);
  glm::dmat4 placed(turn * (scale * std::min(cellWidth_, cellHeight_) / 2.0));
  placed[3] =
      glm::dvec4((column + 0.5) * cellWidth_ - aspect_, 1.0 - (row + 0.5) * cellHeight_, -distance_, 1.0);
  return placed;
}

scene::Mesh loadFitted(const std::string& model) {
  const scene::Scene loaded = scene::load(nameForLoading(model));
  scene::Pose pose;
  scene::evaluatePose(loaded, -1, 0.0, pose);
  scene::Mesh mesh;
  mesh.name = model;
  std::vector<glm::dvec3> positions;
  for (const scene::Instance& instance : pose.instances) {
    append(loaded.meshes[instance.mesh], instance.toWorld, mesh, positions);
  }
  require(!mesh.indices.empty(), "the model has no triangles");

  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  const glm::dvec3 centre = 0.5 * (low + high);
  double square = 0.0;
  for (const glm::dvec3& p : positions) square = std::max(square, glm::dot(p - centre, p - centre));
  for (const glm::dvec3& p : positions) {
    mesh.positions.push_back(glm::vec3((p - centre) / std::sqrt(square)));
    mesh.texcoords.emplace_back(2.0f * mesh.positions.back().x, 2.0f * mesh.positions.back().y);
  }
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size() / 3), 0}};
  return mesh;
}

std::vector<std::uint8_t> checkerTexture() {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(std::size_t{4} * kTextureSize * kTextureSize);
  std::uint32_t noise = 1;
  for (int row = 0; row < kTextureSize; ++row) {
    for (int column = 0; column < kTextureSize; ++column) {
      noise = noise * 1664525u + 1013904223u;
      const bool bright = ((column / 64 ^ row / 64) & 1) != 0;
      const auto value = static_cast<std::uint8_t>((bright ? 220u : 120u) + (noise >> 27));
      rgba.insert(rgba.end(), {value, value, static_cast<std::uint8_t>(value / 2), 255});
    }
  }
  return rgba;
}

}  // namespace limn::bench
