// How large a view shows lengths of the model, at most.
#pragma once

#include <glm/vec3.hpp>

#include "silhouette/mesh.h"

namespace limn::silhouette {

/// Covers the roundings of bounds.
inline constexpr float kRounding = 1.001f;

/// Computed once per view.
class ViewScale {
 public:
  explicit ViewScale(const View& view);

  /// Pixels that a unit of the model measures at most within a sphere, depths clamped to the near plane. Differences of
  /// points as pixel_bound.h has them are within it.
  float within(const glm::vec3& center, float radius) const;

 private:
  glm::vec3 eye_;
  glm::vec3 axis_;  // depth of a point p: ⟨axis, p⟩ + offset
  float offset_;
  float stretch_;  // at most so much does the view matrix lengthen
  float pixels_;   // per unit at depth 1
  float nearPlane_;
  bool perspective_;
};

}  // namespace limn::silhouette
