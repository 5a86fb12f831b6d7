// From distances in space to distances in pixels, with a guarantee.
//
// Based on: G. Wang, "The subdivision method for finding the intersection between two Bézier curves or
// surfaces", 1984: a cubic and its polyline of n equal steps are at most 3/4 of the largest second difference
// of the control points over n² apart.
// Differs in: perspective. Wang's bound holds for polynomial curves, the projection
// of a cubic is a rational one. With c a point of the curve, l = c - δ the point of its chord at the same
// parameter, z the depth and s = l_xy / l_z,
//
//   c_xy / c_z - l_xy / l_z = (δ_xy - s δ_z) / c_z                                       (exactly)
//
// and δ_xy - s δ_z is, for a fixed slope s, the chord's error of the cubic with control points b_xy - s b_z,
// a polynomial one: at most 3/4 of its largest second difference over n². That is convex in s, and l's
// projection lies in the convex hull of the projected control points, so the largest value is found at one of
// the four. With the least depth of the control points below, n = sqrt(3/4 · max |D_xy - s D_z| / (z_min ·
// tolerance)) segments suffice, from the curve to the polyline and back, since both points at a parameter are
// that close.
//
// Depths are clamped to the near plane: the bound holds for curves beyond it; one that crosses it gets at
// least the segments of what is visible of it, up to the cap.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "silhouette/edge_curves.h"

namespace limn::silhouette {

/// What a view makes of a point p: linear p + origin has pixels per unit of depth twice, and the depth (positive in
/// front).
struct PixelMap {
  /// 3/4, and a share that covers the roundings of the bound's own evaluation; in real numbers it is exact.
  static constexpr float kChordFactor = 0.75f * 1.0001f;

  glm::mat3 linear{1.0f};
  glm::vec3 origin{0.0f};
  float nearPlane = 0;
  bool perspective = true;
};

class PixelBound {
 public:
  explicit PixelBound(const View& view);

  /// Upper bound of the distance in pixels between a cubic and its chord; n segments have 1/n² of it.
  float chordError(const glm::vec3& p, const glm::vec3& q, const CurveOffsets& d) const;

  /// Where a point is seen: pixels to the right of the middle of the window and above it, the depth clamped to the near
  /// plane.
  glm::vec2 place(const glm::vec3& p) const {
    const glm::vec3 seen = toView(p);
    return map_.perspective ? glm::vec2(seen) / std::max(seen.z, map_.nearPlane) : glm::vec2(seen);
  }
  /// Distance in pixels between the places of two points.
  float distance(const glm::vec3& p, const glm::vec3& q) const { return glm::length(place(p) - place(q)); }

  const PixelMap& map() const { return map_; }

 private:
  glm::vec3 toView(const glm::vec3& p) const { return map_.linear * p + map_.origin; }

  PixelMap map_;
};

/// The least number of segments whose error is within the tolerance, at least 1; `capped` is set when that is
/// more than kMaxSegments, which is then returned.
inline int segmentsFor(float chordError, float tolerance, bool& capped) {
  if (chordError <= tolerance) return 1;
  const float wanted = std::ceil(std::sqrt(chordError / tolerance));
  capped = !(wanted <= static_cast<float>(kMaxSegments));
  return capped ? kMaxSegments : static_cast<int>(wanted);
}

}  // namespace limn::silhouette
