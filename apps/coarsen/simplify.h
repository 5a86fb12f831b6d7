// Fewer triangles whose vertices are vertices of the mesh, chosen for the outline.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "apps/coarsen/surface.h"

namespace limn::coarsen {

struct Simplified {
  std::vector<Index> indices;    ///< three vertices per triangle, vertices of the source
  std::vector<Index> triangles;  ///< the source triangle that each one was made from: it has its material
};

/// What the simplifier must know of a mesh: `pointOf` and `surface` as makeSurface() gives them.
struct SimplifyInput {
  std::span<const Index> indices;        ///< three vertices per triangle, materials side by side
  std::span<const glm::vec3> normals;    ///< of vertices
  std::span<const glm::vec2> texcoords;  ///< of vertices, or none
  std::span<const Index> pointOf;
  std::span<const Index> groupOf;  ///< of triangles: their materials
  const Surface& surface;
  std::span<const double> weights;  ///< of points, outlineWeights()
};

/// Collapses edges until at most `triangles` are left, or no collapse is possible that keeps the topology. A closed
/// surface stays closed, a manifold one manifold, boundaries stay boundaries. Texture seams, creases and borders of
/// materials collapse along themselves as long as that is enough to get there. `progress` gets a number from 0 to 1.
Simplified simplify(const SimplifyInput& input, std::size_t triangles,
                    const std::function<void(double)>& progress = {});

}  // namespace limn::coarsen
