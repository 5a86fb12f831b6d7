// Fine meshes for coarsening, and what the tests of this folder ask of coarse ones.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>

#include "apps/scene/builtin.h"
#include "apps/scene/scene.h"
#include "silhouette/topology.h"

namespace limn::coarsen::test {

inline scene::Mesh builtinMesh(const std::string& name) {
  return scene::makeBuiltin(name).meshes.at(0);
}

inline silhouette::Mesh shapeOf(const scene::Mesh& mesh) {
  return {mesh.positions, mesh.normals, mesh.indices};
}

/// Points - edges + triangles of the welded mesh.
inline long eulerCharacteristic(const scene::Mesh& mesh) {
  const silhouette::Topology topology(shapeOf(mesh));
  return static_cast<long>(topology.pointCount()) - static_cast<long>(topology.edges().size()) +
         static_cast<long>(mesh.indices.size() / 3);
}

/// A bumpy height field with a boundary over [-1, 1]², two materials (x < 0 and x > 0), and a texture seam where they meet.
inline scene::Mesh bumpyField(int cells) {
  scene::Mesh mesh;
  const auto height = [](float x, float y) { return 0.25f * (x * x * x - 2.0f * x * y * y); };
  for (const int half : {0, 1}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto firstTriangle = static_cast<std::uint32_t>(mesh.indices.size() / 3);
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= 2 * cells; ++j) {
        const float x = static_cast<float>(half - 1) + static_cast<float>(i) / static_cast<float>(cells);
        const float y = -1.0f + static_cast<float>(j) / static_cast<float>(cells);
        mesh.positions.push_back({x, y, height(x, y)});
        mesh.normals.push_back(glm::normalize(glm::vec3(-0.25f * (3 * x * x - 2 * y * y), x * y, 1.0f)));
        mesh.texcoords.push_back({x - static_cast<float>(half), y});
      }
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (2 * cells + 1) + j); };
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < 2 * cells; ++j)
        mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                                 at(i + 1, j + 1), at(i, j + 1)});
    mesh.parts.push_back({firstTriangle, static_cast<std::uint32_t>(mesh.indices.size() / 3) - firstTriangle,
                          static_cast<std::uint32_t>(half)});
  }
  return mesh;
}

}  // namespace limn::coarsen::test
