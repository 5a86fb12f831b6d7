// Edges beside the silhouette curves that stand out from them in the flat outline.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, (1) and (2), for the
// silhouetteness. Differs in: an edge takes part only where the viewer sees its chord or its curve beside the
// contour in the triangles at it, which on convex smooth shapes never happens. What is left are the chords that
// would hide a concave segment, and edges where the faces and their normals disagree. Whether a silhouette
// curve crosses the edge does not matter: its silhouette point lies among the samples of the curve, so that
// nothing jumps when one enters.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "silhouette/contour.h"
#include "silhouette/curve_set.h"

namespace limn::silhouette {

struct RingTest {
  static constexpr float kBeta = 0.02f;  ///< of (2): narrow, what matters is the outline

  const Mesh& mesh;
  const Topology& topology;
  const CurveSet& curves;
  const View& view;
  std::span<const std::uint8_t> visible;  ///< per vertex of the mesh
  std::span<const float> heights;         ///< likewise: ⟨n, v⟩
  const std::vector<SilhouettePoints>& points;
  std::span<const std::uint32_t> pointsOf;  ///< per edge that is crossed: index into points

  /// No edge of which the product of the eye's distances from the planes of its faces is as large as this has
  /// an α.
  float largestProduct() const;

  /// (2) of a smooth edge with a curve.
  float silhouetteness(std::uint32_t e) const;
  /// Its α, given that, where it is not 0.
  float alpha(std::uint32_t e, float silhouetteness) const;

 private:
  /// The middle of an edge's chord, what its curve adds there, and 1 / the edge's length.
  struct Middle {
    glm::vec3 chord, offset;
    float scale;
  };
  float coverOf(std::uint32_t corner) const;
  float standsOut(const Middle& edge, const glm::vec3& place, const glm::vec3& unitNormal) const;
  float besideSegment(const Middle& edge, const Side& face) const;
  float besideCorners(const Middle& edge, const Side& face) const;
};

}  // namespace limn::silhouette
