#include "silhouette/pixel_bound.h"

namespace limn::silhouette {
namespace {

using glm::vec2;
using glm::vec3;

// The bound is exact in real numbers; this covers the roundings of its own evaluation.
constexpr float kRounding = 1.0001f;

}  // namespace

PixelBound::PixelBound(const View& view)
    : nearPlane_(view.projection.nearPlane), perspective_(view.projection.perspective) {
  const vec3 scale(view.projection.pixelsX, view.projection.pixelsY, -1.0f);
  for (int column = 0; column < 3; ++column) linear_[column] = scale * vec3(view.modelToView[column]);
  origin_ = scale * vec3(view.modelToView[3]);
}

float PixelBound::chordError(const vec3& p, const vec3& q, const CurveOffsets& d) const {
  const vec3 start = toView(p), end = toView(q);
  const vec3 d0 = linear_ * d[0], d1 = linear_ * d[1];
  const vec3 second[2] = {d1 - 2.0f * d0, d0 - 2.0f * d1};  // b0 - 2 b1 + b2 and b1 - 2 b2 + b3
  float largest = 0.0f;
  if (!perspective_) {
    for (const vec3& D : second) largest = std::max(largest, glm::length(vec2(D)));
    return 0.75f * kRounding * largest;
  }
  const vec3 control[4] = {start, (2.0f * start + end) / 3.0f + d0, (start + 2.0f * end) / 3.0f + d1, end};
  float nearest = control[0].z;
  for (const vec3& b : control) nearest = std::min(nearest, b.z);
  for (const vec3& b : control) {
    const vec2 slope = vec2(b) / std::max(b.z, nearPlane_);
    for (const vec3& D : second) largest = std::max(largest, glm::length(vec2(D) - D.z * slope));
  }
  return 0.75f * kRounding * largest / std::max(nearest, nearPlane_);
}

float PixelBound::distance(const vec3& p, const vec3& q) const {
  const vec3 a = toView(p), b = toView(q);
  if (!perspective_) return glm::length(vec2(a) - vec2(b));
  return glm::length(vec2(a) / std::max(a.z, nearPlane_) - vec2(b) / std::max(b.z, nearPlane_));
}

}  // namespace limn::silhouette
