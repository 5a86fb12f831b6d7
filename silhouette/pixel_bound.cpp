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

CurveError PixelBound::curveError(const vec3& p, const vec3& q, const CurveOffsets& d) const {
  const vec3 d0 = map_.linear * d[0], d1 = map_.linear * d[1];
  const vec3 first = d1 - 2.0f * d0, second = d0 - 2.0f * d1;  // b0 - 2 b1 + b2 and b1 - 2 b2 + b3
  float bend = 0.0f, middle = 0.0f, turn = 0.0f;               // squared
  const auto widen = [&](const vec2& one, const vec2& two) {
    const vec2 half = 0.5f * (one + two), difference = two - one;
    bend = std::max(bend, std::max(dot(one, one), dot(two, two)));
    middle = std::max(middle, dot(half, half));
    turn = std::max(turn, dot(difference, difference));
  };
  float nearest = 1.0f;
  if (map_.perspective) {
    const vec3 start = toView(p), end = toView(q), third = (end - start) / 3.0f;
    const vec3 control[4] = {start, start + third + d0, end - third + d1, end};
    nearest = std::min(std::min(control[0].z, control[1].z), std::min(control[2].z, control[3].z));
    nearest = std::max(nearest, map_.nearPlane);
    for (const vec3& b : control) {
      const vec2 slope = vec2(b) * (1.0f / std::max(b.z, map_.nearPlane));
      widen(vec2(first) - first.z * slope, vec2(second) - second.z * slope);
    }
  } else {
    widen(vec2(first), vec2(second));
  }
  const float ofBend = PixelMap::kChordFactor * std::sqrt(bend) / nearest;
  const float ofChord =
      (PixelMap::kChordFactor * std::sqrt(middle) + PixelMap::kTurnFactor * std::sqrt(turn)) / nearest;
  return {ofBend, std::min(ofBend, ofChord)};
}

}  // namespace limn::silhouette
