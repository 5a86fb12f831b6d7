// Borrowed arrays of a coarse mesh, and the viewpoint it is refined for.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "raster/base/projection.h"

namespace limn::silhouette {

/// A triangle mesh. A vertex is one combination of position, normal and whatever else the caller attaches to
/// it; texture seams and creases have several vertices at one position.
///
/// Topology checks the lengths of the arrays and the range of the indices, once. The numbers are the caller's duty: with
/// others than below nothing out of range is read or written, but what is drawn means nothing.
struct Mesh {
  std::span<const glm::vec3> positions;    ///< model space, finite, magnitude up to 1e6
  std::span<const glm::vec3> normals;      ///< unit shading normals, one per vertex; a zero one bends nothing
  std::span<const std::uint32_t> indices;  ///< three per triangle, counter-clockwise seen from outside

  std::size_t triangleCount() const { return indices.size() / 3; }
};

/// A viewpoint, in the mesh's own space, and how that space maps to pixels. `eye` and `direction` say again what
/// `modelToView` says: silhouettes are found by the former, pixels counted by the latter. makeView() makes them agree; who
/// fills a View by hand has to.
struct View {
  Projection projection;
  glm::mat4 modelToView{1.0f};  ///< affine, finite; any scale, reflection included
  glm::vec3 eye{0.0f};          ///< perspective: the eye `o`, which modelToView takes to the origin
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< orthographic: the unit direction `d` of looking, taken to -z
};

/// The view of a mesh placed by `modelToView`, computed in double precision (the eye's model position loses
/// nothing to far-away placements). Throws std::invalid_argument when the matrix is singular or not finite.
View makeView(const Projection& projection, const glm::dmat4& modelToView);

}  // namespace limn::silhouette
