// Where the contour crosses many edges at a time.
#pragma once

#include <glm/vec3.hpp>

#include "silhouette/mesh.h"
#include "silhouette/vector_batch.h"

namespace limn::silhouette {

/// p[0], p[1] and n[0], n[1] of edges whose ends differ in visibility (contour.h), d[0] and d[1] of their curves.
using CrossedBatch = VectorBatch<6>;

/// Of up to 64 crossed edges.
struct Crossings {
  float parameters[CrossedBatch::kCapacity];  ///< contourParameter()
  VectorBatch<3> vectors;  ///< the curve's point there, bridgeNormal(), and that over its length
  float squares[CrossedBatch::kCapacity];  ///< of that length; where it is 0 the last vector is not finite

  glm::vec3 place(std::size_t i) const { return vectors.vector(0, i); }
  glm::vec3 normal(std::size_t i) const { return vectors.vector(1, i); }
  glm::vec3 unit(std::size_t i) const { return vectors.vector(2, i); }
};

/// The vector units of the machine do it; the same bits as computeCrossingsScalar on all of them.
void computeCrossings(const View& view, const CrossedBatch& edges, Crossings& crossings);

/// The definition of correct.
void computeCrossingsScalar(const View& view, const CrossedBatch& edges, Crossings& crossings);

}  // namespace limn::silhouette
