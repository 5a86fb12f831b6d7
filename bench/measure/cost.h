// methods/5-measures.md, 5.3: what a method costs, beside the flat mesh in the same run.
#pragma once

#include <vector>

#include "bench/measure/accuracy.h"

namespace limn::measure {

/// Frame times of one variant: averages over the views of the least and of the median time in each.
struct Cost {
  double minMs = 0.0, medianMs = 0.0;
  double refineMs = 0.0;   ///< of the least frames: classification and refinement
  double triangles = 0.0;  ///< submitted per frame
  /// Half of the frames took over 1.5 times the least: something else was running.
  bool disturbed() const { return medianMs > 1.5 * minMs; }
};

/// Frames of 1280 × 800 with four samples and the method's own camera of `limn render`; the variants take turns, `rounds`
/// times, so that whatever disturbs the machine disturbs all of them.
std::vector<Cost> measureCosts(const std::string& model, const std::vector<Variant>& variants, int views,
                               int rounds, int threads);

}  // namespace limn::measure
