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
// Curves that bend more at one end than at the other, or both ways, stay closer to few segments than Wang's bound says.
// Second differences run linearly from D_0 to D_1, so at σ of a step of length h whose middle is at t the curve is away
// from its chord by
//
//   3 σ (1-σ) h² |(1 - 2σ) h (D_1 - D_0) / 6 - D(t)| <= h² (3/4 |D(t)| + √3/36 h |D_1 - D_0|)
//
// |D| is convex, so the first or the last step has the most of it: there D(t) is 1 - h of D_0 or D_1 and h of D(1/2). With
// W = 3/4 max(|D_0|, |D_1|), Wang's, and C = 3/4 |D(1/2)| + √3/36 |D_1 - D_0|, which is the chord's own bound, that is at
// most (W + (C - W) / n) / n² for n steps.
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

/// What a view makes of a point p: linear p + origin = (x, y, depth), the depth positive in front of the eye. In perspective
/// x / depth and y / depth are pixels from the middle of the window, else x and y.
struct PixelMap {
  /// 3/4, and a share that covers the roundings of the bound's own evaluation; in real numbers it is exact.
  static constexpr float kChordFactor = 0.75f * 1.0001f;
  static constexpr float kTurnFactor = 0.0481126f * 1.0001f;  ///< √3/36, likewise

  glm::mat3 linear{1.0f};
  glm::vec3 origin{0.0f};
  float nearPlane = 0;
  bool perspective = true;
};

/// Upper bounds of the distance in pixels between a cubic and its polylines.
struct CurveError {
  float bend = 0;   ///< n segments have 1/n² of it
  float chord = 0;  ///< one segment; at most `bend`. n segments have (bend + (chord - bend) / n) / n²
};

class PixelBound {
 public:
  explicit PixelBound(const View& view);

  CurveError curveError(const glm::vec3& p, const glm::vec3& q, const CurveOffsets& d) const;

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
inline int segmentsFor(const CurveError& error, float tolerance, bool& capped) {
  capped = false;
  if (error.chord <= tolerance) return 1;
  // n³ times the bound, so that nothing is divided: counts are small nearly always.
  const auto suffices = [&](float n) {
    return error.bend * n + (error.chord - error.bend) <= tolerance * (n * n * n);
  };
  int n = 2;
  while (n < kMaxSegments && !suffices(static_cast<float>(n))) ++n;
  capped = n == kMaxSegments && !suffices(static_cast<float>(n));
  return n;
}

}  // namespace limn::silhouette
