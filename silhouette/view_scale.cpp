#include "silhouette/view_scale.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn::silhouette {

using glm::dot;
using glm::vec3;

ViewScale::ViewScale(const View& view)
    : eye_(view.eye),
      axis_(-view.modelToView[0][2], -view.modelToView[1][2], -view.modelToView[2][2]),
      offset_(-view.modelToView[3][2]),
      pixels_(std::max(view.projection.pixelsX, view.projection.pixelsY)),
      nearPlane_(view.projection.nearPlane),
      perspective_(view.projection.perspective) {
  // A similarity lengthens by its columns' length; of other matrices the Frobenius norm is a bound.
  float longest = 0.0f, sum = 0.0f, skew = 0.0f;
  for (int k = 0; k < 3; ++k) {
    const vec3 column(view.modelToView[k]), next(view.modelToView[(k + 1) % 3]);
    longest = std::max(longest, glm::length(column));
    sum += dot(column, column);
    skew = std::max(skew, std::fabs(dot(column, next)));
  }
  stretch_ = kRounding * (skew > 1e-4f * sum ? std::sqrt(sum) : longest);
}

float ViewScale::within(const vec3& center, float radius) const {
  if (!perspective_) return stretch_ * pixels_;
  const float reach = radius * stretch_;
  const float nearest = dot(axis_, center) + offset_ - reach;
  const float foremost = std::max(nearest, 0.0f), clamped = std::max(nearest, nearPlane_);
  // |δ_xy - s δ_z| <= |δ| √(1 + s²), s the steepest slope of a point of the sphere (pixel_bound.h).
  const float distance = glm::length(center - eye_) * stretch_ + reach;
  const float slope2 = std::max(0.0f, distance * distance - foremost * foremost) / (clamped * clamped);
  return kRounding * stretch_ * pixels_ * std::sqrt(1.0f + slope2) / clamped;
}

}  // namespace limn::silhouette
