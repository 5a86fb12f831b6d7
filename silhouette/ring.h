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

#include "silhouette/curve_set.h"

namespace limn::silhouette {

struct RingTest {
  const Mesh& mesh;
  const Topology& topology;
  const CurveSet& curves;
  const View& view;
  std::span<const std::uint8_t> visible;  ///< per vertex of the mesh
  std::span<const float> heights;         ///< likewise: ⟨n, v⟩
  std::span<const std::array<float, 2>>
      crossings;  ///< per edge and face, where it crosses: contourParameter()

  /// No edge of which the product of the eye's distances from the planes of its faces is as large as this has
  /// an α.
  float largestProduct() const;

  /// α of a smooth edge; 0 for others.
  float alpha(std::uint32_t e) const;

 private:
  float coverOf(std::uint32_t corner) const;
  float standsOut(std::uint32_t e, const glm::vec3& place, const glm::vec3& normal) const;
  float exposed(std::uint32_t e, const Side& face) const;
};

}  // namespace limn::silhouette
