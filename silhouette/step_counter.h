// The numbers of steps of many polylines, counted by batches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "silhouette/chord_kernel.h"
#include "silhouette/contour.h"
#include "silhouette/refine.h"

namespace limn::silhouette {

/// Steps of polylines with their inner vertices outside the curve (contour.h) that stay within the tolerance.
class StepCounter {
 public:
  /// Borrows both.
  StepCounter(const PixelBound& bound, const Parameters& parameters)
      : bound_(bound), parameters_(parameters) {}

  /// Sets `steps`, at the latest in finish(); until then it must not move.
  void add(const glm::vec3& p, const glm::vec3& q, const CurveOffsets& offsets, std::uint32_t& steps) {
    wanted_[batch_.count] = &steps;
    batch_.add(p, q, offsets[0], offsets[1]);
    if (batch_.count == CurveBatch::kCapacity) count();
  }

  /// Returns how many wanted more than kMaxSegments.
  std::size_t finish() {
    count();
    return capped_;
  }

 private:
  void count() {
    CurveErrors errors{};
    if (parameters_.segments == 0) curveErrors(bound_, batch_, errors);
    for (std::size_t i = 0; i < batch_.count; ++i) {
      bool capped = false;
      *wanted_[i] = static_cast<std::uint32_t>(
          parameters_.segments > 0 ? parameters_.segments
                                   : polylineSteps(errors.bends[i], parameters_.tolerance, capped));
      capped_ += capped ? 1 : 0;
    }
    batch_.count = 0;
  }

  const PixelBound& bound_;
  const Parameters& parameters_;
  CurveBatch batch_{};
  std::array<std::uint32_t*, CurveBatch::kCapacity> wanted_;
  std::size_t capped_ = 0;
};

}  // namespace limn::silhouette
