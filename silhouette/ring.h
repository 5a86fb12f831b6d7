// Edges beside the silhouette curves that stand out from them in the flat outline.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, (1) and (2), for the
// silhouetteness. Differs in: only edges that no silhouette curve crosses take part, faded out where one comes
// near an end (it takes over there) and where the edge's own curve stays behind the segment of a triangle
// beside it, as on every convex smooth shape. What is left are edges where the faces and their normals
// disagree, and edges that would hide a concave segment. On scanned shapes they carry a tenth of the gain.
#pragma once

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

  /// α of a smooth edge whose ends are both visible or both not; 0 for others.
  float alpha(std::uint32_t e) const;

 private:
  float facingOf(std::uint32_t vertex) const;
  float standsOut(std::uint32_t e, const Side& face) const;
};

}  // namespace limn::silhouette
