// Robust ends: how far an edge's curve may be believed, from the coarse mesh and its normals alone.
//
// Based on: nothing published. The butterfly stencil is that of N. Dyn, D. Levin, J. Gregory, "A butterfly
// subdivision scheme for surface interpolation with tension control", 1990.
//
// Normals of a simplified mesh are not those of a smooth shape sampled finely enough: the curves that they
// ask for leave a fifth to a third of all views of scanned models worse than the flat mesh. The harm is done
// at creases that nobody marked, where normals tilted by 45 degrees on flat faces blow them up, and by detail
// finer than the mesh. With the tilts h_i = -⟨ê, n_i⟩ and h_j = ⟨ê, n_j⟩ (both positive where the curve rises
// above the edge), an end's offset is scaled by three factors, each continuous in positions and normals:
//
//  * limiter    min(1, k h_j / h_i), not below 0: an end does not bend much more than the other, nor the
//  other way.
//  * witness    0…1 as b grows from -0.1 to 0.4 of the bulge (h_i + h_j)/8 that the normals ask for, where b
//  is the
//               bulge that the positions around the edge ask for (butterfly) and τ times the dihedral angle
//               is granted for the stencil's own error. The cap of a can fails: its positions are flat.
//  * tilt       1…0 as the larger tilt grows by 0.25 from an onset between 0.35 and 1.15: later where the
//  normals tell
//               more than the mesh's own faces do, by their distance from the mean of the faces around a
//               vertex.
//
// They are measured on smooth ends of edges without features; boundaries have no witness.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/method.h"

namespace limn::silhouette {

class RobustEnds {
 public:
  /// Borrows mesh and topology until the next call.
  void prepare(const Mesh& mesh, const Topology& topology, const Crew& crew);

  /// Factors of d_ij and d_ji of an edge without features, each in [0, 1].
  std::array<float, 2> factors(const Edge& edge) const;

 private:
  float deviation(std::uint32_t vertex) const;
  bool butterflyOffset(const Edge& edge, const glm::vec3& start, glm::vec3& offset) const;

  Mesh mesh_;
  const Topology* topology_ = nullptr;
  std::vector<glm::vec3> faceNormals_;  // unit
  std::vector<glm::vec3> ringNormals_;  // per point: angle-weighted mean of the faces around it, not unit
};

}  // namespace limn::silhouette
