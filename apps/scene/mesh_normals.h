// Normals for meshes that come without: weighted by angle, split where the surface turns sharply.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace limn::scene {

/// Which vertices share a normal. A group is the corners around one point that hang together over edges which
/// turn by at most the crease angle.
struct NormalGroups {
  std::vector<std::uint32_t> copies;   ///< vertices to append, each a copy of the one named here
  std::vector<std::uint32_t> corners;  ///< places in `indices` of the corners looked at
  std::vector<std::uint32_t> groups;  ///< of each of those corners; a group is named after one of its corners
};

/// Groups the corners `corners` (places in `indices`, three after three make a triangle). Vertices are welded
/// by position for this. A vertex whose corners fall into several groups is divided: `indices` then name its
/// copies, numbered from positions.size() on.
NormalGroups groupCorners(std::span<const glm::vec3> positions, std::span<std::uint32_t> indices,
                          std::vector<std::uint32_t> corners, double creaseDegrees);

/// The unit normals of the groups for these positions (one per vertex, copies included), written to the
/// vertices of `groups.corners`. A vertex whose triangles have no area gets `fallback`.
void makeNormals(const NormalGroups& groups, std::span<const glm::vec3> positions,
                 std::span<const std::uint32_t> indices, const glm::vec3& fallback,
                 std::span<glm::vec3> normals);

}  // namespace limn::scene
