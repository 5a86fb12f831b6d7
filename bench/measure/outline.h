// The outline of a mask as closed polygons, and what is measured on it.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "bench/measure/mask.h"

namespace limn::measure {

/// Closed polygons in pixels, holes included; the last point joins the first. Outlines inside the mask, where
/// a surface hides itself, are not in it.
struct Outline {
  std::vector<std::vector<glm::dvec2>> contours;
};

/// Follows the border between set and clear samples and fits the longest straight pieces that stay within
/// kOutlineTolerance of it, so that lengths are those of the curve and not of a staircase.
Outline traceOutline(const Mask& mask);
inline constexpr double kOutlineTolerance = 0.75 / kSamplesPerPixel;  ///< pixels

/// Pixels. Within 0.1 % of the truth on discs and polygons of 20 pixels and more.
double length(const Outline& outline);

/// The largest angle, in degrees, between two consecutive pieces of the outline that are kCornerReach long: a
/// polygon's largest exterior angle; for a smooth curve kCornerReach times the largest curvature (a disc of
/// radius R: 229°/R). Contours shorter than four pieces are left out. Good to 2°.
double largestTurn(const Outline& outline);
inline constexpr double kCornerReach = 4.0;  ///< pixels

/// Distances between two outlines: the larger of the two directions.
struct OutlineDistance {
  double p95 = 0.0;  ///< 95th percentile over the length of an outline, pixels
  double max = 0.0;  ///< Hausdorff distance, pixels
};
/// Both outlines within a window of width × height pixels. Good to 1/16 pixel. An empty outline has no
/// distance: 0.
OutlineDistance outlineDistance(const Outline& a, const Outline& b, int width, int height);

}  // namespace limn::measure
