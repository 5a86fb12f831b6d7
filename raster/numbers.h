// Small arithmetic that must be the same everywhere.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace limn::raster {

inline float dot(const glm::vec3& a, const glm::vec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

inline bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The larger one, and b where either is NaN: what the vector instructions give.
inline float larger(float a, float b) {
  return a > b ? a : b;
}

}  // namespace limn::raster
