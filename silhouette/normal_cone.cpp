#include "silhouette/normal_cone.h"

#include <cmath>

#include "silhouette/view_scale.h"

namespace limn::silhouette {
namespace {

constexpr float kMargin = 1e-3f;  // in cosines

}  // namespace

void NormalCone::begin(const glm::vec3& low, const glm::vec3& high, const glm::vec3& sum) {
  center = 0.5f * (low + high);
  radius = 0.5f * kRounding * glm::length(high - low);
  const float length = glm::length(sum);
  axis = length > 0.0f ? sum / length : glm::vec3(0.0f);
  cosine = length > 0.0f ? 1.0f : -1.0f;
}

void NormalCone::finish() {
  cosine -= kMargin;
  sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
}

// With θ the angle between the axis and the line of sight, ω that of the cone and δ that of the sphere, all facings are at
// least cos(θ + ω + δ) in size and of one sign. They differ by at most |n - n'| + |v - v'| <= 2 (sin ω + sin δ).
FacingBound NormalCone::facings(const View& view) const {
  if (cosine <= 0.0f) return {};
  glm::vec3 sight = -view.direction;
  float sinDelta = 0.0f;
  if (view.projection.perspective) {
    sight = view.eye - center;
    const float distance = glm::length(sight);
    if (!(distance > radius)) return {};
    sight /= distance;
    sinDelta = radius / distance;
  }
  const float cosDelta = std::sqrt(1.0f - sinDelta * sinDelta);
  const float cosTheta = std::min(1.0f, std::fabs(glm::dot(sight, axis)));
  const float sinTheta = std::sqrt(1.0f - cosTheta * cosTheta);
  const float cosSum = cosTheta * cosine - sinTheta * sine;
  const float sinSum = sinTheta * cosine + cosTheta * sine;
  if (cosSum <= 0.0f) return {};
  const float least = cosSum * cosDelta - sinSum * sinDelta - kMargin;
  if (!(least > 0.0f)) return {};
  return {least, std::min(1.0f - least, 2.0f * (sine + sinDelta) + kMargin)};
}

}  // namespace limn::silhouette
