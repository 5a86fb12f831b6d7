// The cubic Bézier triangle over a mesh triangle, kept as what it adds to the flat triangle.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, section 3; A. Vlachos, J.
// Peters, C. Boyd, J. Mitchell, "Curved PN triangles", 2001. Differs in: control points are offsets from
// those of the flat triangle. The straight parts of b111 cancel and its offset is a quarter of the sum of the
// six others.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "silhouette/edge_curves.h"

namespace limn::silhouette {

struct Patch {
  std::array<glm::vec3, 3> corners;
  /// Side k runs from corner k to corner k + 1: α d at its start and at its end.
  std::array<CurveOffsets, 3> sides{};
  /// What a fitted patch adds to the offset of b111.
  glm::vec3 fittedCenter{0.0f};

  /// The offset of b111.
  glm::vec3 centre() const {
    return 0.25f * ((sides[0][0] + sides[0][1]) + (sides[1][0] + sides[1][1]) + (sides[2][0] + sides[2][1])) +
           fittedCenter;
  }

  /// What the patch adds to the flat triangle at the weights of the corners, u + v + w = 1.
  glm::vec3 offset(float u, float v, float w) const {
    const glm::vec3 boundary = u * v * (u * sides[0][0] + v * sides[0][1]) +
                               v * w * (v * sides[1][0] + w * sides[1][1]) +
                               w * u * (w * sides[2][0] + u * sides[2][1]);
    return 3.0f * boundary + 6.0f * u * v * w * centre();
  }

  glm::vec3 flatPoint(float u, float v, float w) const {
    return u * corners[0] + v * corners[1] + w * corners[2];
  }
  glm::vec3 point(float u, float v, float w) const { return flatPoint(u, v, w) + offset(u, v, w); }
};

}  // namespace limn::silhouette
