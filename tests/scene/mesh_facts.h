// What tests ask of a mesh: its edges welded by position, its Euler characteristic, where its triangles face.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <set>
#include <utility>

#include "apps/scene/scene.h"

namespace limn::scene::test {

struct MeshFacts {
  std::size_t points = 0, edges = 0, triangles = 0;
  bool closedManifold = true;  ///< every edge is run along once in each direction
  std::size_t inward = 0;      ///< triangles that face against the sum of their normals

  long eulerCharacteristic() const {
    return static_cast<long>(points) - static_cast<long>(edges) + static_cast<long>(triangles);
  }
};

inline MeshFacts factsOf(const Mesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> welded;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  MeshFacts facts;
  facts.triangles = mesh.indices.size() / 3;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<std::uint32_t, 3> id{};
    glm::vec3 normals(0), p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = mesh.positions[mesh.indices[t + k]];
      normals += mesh.normals[mesh.indices[t + k]];
      id[k] = welded
                  .emplace(std::array{p[k].x + 0.0f, p[k].y + 0.0f, p[k].z + 0.0f},
                           static_cast<std::uint32_t>(welded.size()))
                  .first->second;
    }
    if (glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), normals) <= 0) ++facts.inward;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = id[k], b = id[(k + 1) % 3];
      ++directed[{a, b}];
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  for (const auto& [edge, count] : directed) {
    const auto opposite = directed.find({edge.second, edge.first});
    if (count != 1 || opposite == directed.end()) facts.closedManifold = false;
  }
  facts.points = welded.size();
  facts.edges = edges.size();
  return facts;
}

}  // namespace limn::scene::test
