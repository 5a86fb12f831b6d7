// Robust ends: how far an edge's curve may be believed, from the coarse mesh and its normals alone.
//
// Based on: nothing published. The butterfly stencil is that of N. Dyn, D. Levin, J. Gregory, "A butterfly
// subdivision scheme for surface interpolation with tension control", 1990.
//
// Normals of a simplified mesh are not those of a smooth shape sampled finely enough: the curves that they
// ask for leave a fifth to a third of all views of scanned models worse than the flat mesh. The harm is done
// at creases that nobody marked, where normals tilted by 45 degrees on flat faces blow them up, and by detail
// finer than the mesh. With the tilts h_i = -⟨ê, n_i⟩ and h_j = ⟨ê, n_j⟩ (both positive where the curve rises
// above the edge), an end's offset is scaled by four factors, each continuous in positions and normals:
//
//  * limiter  min(1, k h_j / h_i), not below 0: an end does not bend much more than the other, nor the other way.
//  * witness  0 to 1 as b grows from -0.1 to 0.4 of the bulge (h_i + h_j)/8 that the normals ask for, where b is
//    the bulge that the positions around the edge ask for (butterfly) and τ times the dihedral angle is granted
//    for the stencil's own error. The cap of a can fails: its positions are flat. On regular meshes (see below) a third of
//    what the stencil is off for its shape is granted besides: it puts the middle right on a quadric only where the weighted
//    second moments of its places cancel, as they do in a regular triangulation. With M the moments and the places'
//    heights z over the plane at the edge it is off by about tr |M| times the mean of |z| / r². A flat cap still
//    fails, since its heights are 0; edges around a bent tube in long triangles no longer do.
//  * tilt     1 to 0 as the larger tilt grows by 0.25 from an onset between 0.35 and 1.15: later where the normals
//    tell more than the mesh's own faces do, by their distance from the mean of the faces around a vertex.
//
//  * turn     0 to 1 as the normals turn by up to a third, h_i + h_j, of what they would had the edge all along the
//    curvature that they show around its ends: along a flat face from one rounded corner to another they turn
//    near the ends alone, and an arc as long as the edge is not what they ask for.
//
// Edges with features are left alone; boundaries have no witness. The limiter is a doubt about normals that scatter; it
// fades to nothing as the differences of the edges' tilts, on average over the mesh, fall from 0.3 to 0.15 of the tilts
// themselves: there the mesh resolves the curvature of a smooth shape (0 to 0.14 on regular samples of spheres, tori and
// knots, 0.5 and more on simplified scans).
//
// Before all that stands the question what the normals tell at all. Those of a surface that was sampled finely and
// then simplified deviate from the means of the coarse faces around their vertices, by about as much as tilts differ
// between the two ends of an edge: both are what curvature varies by within an edge. Normals that agree with
// the faces where the tilts do not agree with each other were computed from faces of this very size: they know of no
// rounder shape. With the evidence
//
//   ρ = mean over vertices of sin∠(normal, faces around) / mean over edges of |h_i - h_j|/2
//
// (1 to 3 on surfaces that were sampled finely, 0.4 to 0.6 on simplified polygons, without bound on regular meshes of
// round shapes) a mesh is trusted from 0 to 1 as ρ grows from 0.6 to 0.9. So is, from 0.4 down to 0.15, one whose
// normals are simply the means of its own faces: it was made from nothing finer, and a round shape is what its shading
// asks for.
//
// The price: shapes so coarse that normals turn by more than about 50 degrees along an edge, with normals that
// are no more than the means of their own faces, are left nearly flat.
#pragma once

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/method.h"
#include "silhouette/ring_curvature.h"

namespace limn::silhouette {

/// The limiter min(1, k h_j / h_i), not below 0, of the end whose tilt is `own`.
inline float endLimit(float k, float own, float other) {
  return own == 0.0f ? 1.0f : std::clamp(k * other / own, 0.0f, 1.0f);
}

class RobustEnds {
 public:
  /// Borrows mesh and topology until the next call.
  void prepare(const Mesh& mesh, const Topology& topology, const Crew& crew);

  /// Factors of d_ij and d_ji of an edge without features, each in [0, 1].
  std::array<float, 2> factors(const Edge& edge) const;

  /// Whether normals of this evidence ρ ask for a rounder shape than the faces', in [0, 1].
  static float trustOf(float evidence);

 private:
  /// Of the edges of a block, twice the means' sums.
  struct Evidence {
    double deviations = 0, differences = 0, tilts = 0;
  };
  struct Stencil;
  static float regularityOf(double differences, double tilts);
  void findTrust(const Crew& crew);
  bool butterflyOffset(const Edge& edge, Stencil& stencil) const;

  Mesh mesh_;
  const Topology* topology_ = nullptr;
  std::vector<glm::vec3> faceNormals_;  // unit
  std::vector<glm::vec3> ringNormals_;  // per point: angle-weighted mean of the faces around it, not unit
  std::vector<float>
      deviations_;  // per vertex: sine of the angle between its normal and that of its ring of faces
  std::vector<std::uint8_t> isSmooth_;  // per point: no feature and no boundary around it
  RingCurvature curvature_;
  std::vector<Evidence> evidence_;  // per block of edges
  float trust_ = 1;
  float regularity_ = 0;
};

}  // namespace limn::silhouette
