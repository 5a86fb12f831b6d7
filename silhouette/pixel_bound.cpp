#include "silhouette/pixel_bound.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec2;
using glm::vec3;

}  // namespace

PixelBound::PixelBound(const View& view) {
  map_.nearPlane = view.projection.nearPlane;
  map_.perspective = view.projection.perspective;
  const vec3 scale(view.projection.pixelsX, view.projection.pixelsY, -1.0f);
  for (int column = 0; column < 3; ++column) map_.linear[column] = scale * vec3(view.modelToView[column]);
  map_.origin = scale * vec3(view.modelToView[3]);
}

float PixelBound::chordError(const vec3& p, const vec3& q, const CurveOffsets& d) const {
  const vec3 d0 = map_.linear * d[0], d1 = map_.linear * d[1];
  const vec3 first = d1 - 2.0f * d0, second = d0 - 2.0f * d1;  // b0 - 2 b1 + b2 and b1 - 2 b2 + b3
  if (!map_.perspective)
    return PixelMap::kChordFactor *
           std::sqrt(std::max(dot(vec2(first), vec2(first)), dot(vec2(second), vec2(second))));
  const vec3 start = toView(p), end = toView(q), third = (end - start) / 3.0f;
  const vec3 control[4] = {start, start + third + d0, end - third + d1, end};
  const float nearest = std::min(std::min(control[0].z, control[1].z), std::min(control[2].z, control[3].z));
  float largest = 0.0f;  // squared
  for (const vec3& b : control) {
    const vec2 slope = vec2(b) * (1.0f / std::max(b.z, map_.nearPlane));
    const vec2 one = vec2(first) - first.z * slope, two = vec2(second) - second.z * slope;
    largest = std::max(largest, std::max(dot(one, one), dot(two, two)));
  }
  return PixelMap::kChordFactor * std::sqrt(largest) / std::max(nearest, map_.nearPlane);
}

}  // namespace limn::silhouette
