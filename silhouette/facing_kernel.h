// The facing g of many vertices: unit-view facing, shading normal · unit vector to the eye.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

namespace limn::silhouette {

/// Structure of arrays of positions and normals.
struct VertexArrays {
  const float *x, *y, *z, *nx, *ny, *nz;

  VertexArrays from(std::size_t i) const { return {x + i, y + i, z + i, nx + i, ny + i, nz + i}; }
};

/// facings[i] = ⟨n_i, v_i⟩/|v_i|, 0 where v_i = 0. `eye` is the eye (perspective: v_i = eye - p_i) or the
/// constant vector to it. The vector units of the machine do it; the same bits as computeFacingsScalar on all
/// of them.
void computeFacings(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* facings);

/// The definition of correct.
void computeFacingsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices,
                          std::size_t count, float* facings);

/// heights[i] = ⟨n_i, v_i⟩, not divided: the sign of the facing, and over a triangle's normal and any of its
/// points the distance of the eye from its plane. The same bits as computeHeightsScalar and as facing() of
/// contour.h.
void computeHeights(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* heights);

/// The definition of correct.
void computeHeightsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices,
                          std::size_t count, float* heights);

}  // namespace limn::silhouette
