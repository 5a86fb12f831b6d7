// The cubic Bézier triangle over a mesh triangle, kept as what it adds to the flat triangle.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004, section 3; A. Vlachos, J.
// Peters, C. Boyd, J. Mitchell, "Curved PN triangles", 2001. Differs in: control points are offsets from
// those of the flat triangle. The straight parts of b111 cancel and its offset is a quarter of the sum of the
// six others, so the patch is a sum of one share per side: of side 0 with d_0 and d_1
//
//   B(u, v, w) = 3 u v (u d_0 + v d_1 + w (d_0 + d_1)/2)
//
// The paper blends with α B. A patch that is whole from the contour on blends with min(α/(1 - w), 1) B: the same at the
// side, where w = 0; straight lines towards the opposite corner as far as w = 1 - α; and from there the patch of α = 1.
// Since the crossing silhouetteness has α = 1 - w where the contour crosses the triangle at w, the drawn outline is that
// of the whole patch although the side behind it is hardly smooth.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "silhouette/edge_curves.h"

namespace limn::silhouette {

struct Patch {
  std::array<glm::vec3, 3> corners;
  /// Side k runs from corner k to corner k + 1: d at its start and at its end.
  std::array<CurveOffsets, 3> sides{};
  std::array<float, 3> alphas{1.0f, 1.0f, 1.0f};  ///< of the sides
  /// What a fitted patch adds to the offset of b111.
  glm::vec3 fittedCenter{0.0f};

  bool wholeFromContour = false;

  /// What the patch adds to the flat triangle at the weights of the corners, u + v + w = 1.
  glm::vec3 offset(float u, float v, float w) const {
    const float a = blend(alphas[0], w), b = blend(alphas[1], u), c = blend(alphas[2], v);
    const glm::vec3 boundary = (a * u * v) * share(sides[0], u, v, w) +
                               (b * v * w) * share(sides[1], v, w, u) +
                               (c * w * u) * share(sides[2], w, u, v);
    return 3.0f * boundary + (2.0f * (a + b + c) * u * v * w) * fittedCenter;
  }

  glm::vec3 flatPoint(float u, float v, float w) const {
    return u * corners[0] + v * corners[1] + w * corners[2];
  }
  glm::vec3 point(float u, float v, float w) const { return flatPoint(u, v, w) + offset(u, v, w); }

 private:
  float blend(float alpha, float opposite) const {
    if (!wholeFromContour) return alpha;
    return alpha < 1.0f - opposite ? alpha / (1.0f - opposite) : 1.0f;
  }
  static glm::vec3 share(const CurveOffsets& d, float from, float to, float opposite) {
    return from * d[0] + to * d[1] + (0.5f * opposite) * (d[0] + d[1]);
  }
};

}  // namespace limn::silhouette
