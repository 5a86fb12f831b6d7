// The pixel bound of many edge curves at a time.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "silhouette/pixel_bound.h"

namespace limn::silhouette {

/// Up to 64 curves, structure of arrays.
struct CurveBatch {
  static constexpr std::size_t kCapacity = 64;
  /// x, y and z of p, of q, of d[0] and of d[1].
  float coordinates[12][kCapacity];
  std::size_t count = 0;

  void add(const glm::vec3& p, const glm::vec3& q, const CurveOffsets& d) {
    const glm::vec3* vectors[4] = {&p, &q, &d[0], &d[1]};
    for (std::size_t k = 0; k < 12; ++k) coordinates[k][count] = (*vectors[k / 3])[static_cast<int>(k % 3)];
    ++count;
  }
};

/// Of up to 64 curves.
struct CurveErrors {
  float bends[CurveBatch::kCapacity], chords[CurveBatch::kCapacity];

  CurveError operator[](std::size_t i) const { return {bends[i], chords[i]}; }
};

/// errors[i] = bound.curveError of curve i, to the last bit. The vector units of the machine do it.
void curveErrors(const PixelBound& bound, const CurveBatch& curves, CurveErrors& errors);

}  // namespace limn::silhouette
