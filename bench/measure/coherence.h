// methods/5-measures.md, 5.2: does the outline jump where the camera moves evenly?
#pragma once

#include <vector>

#include "bench/measure/accuracy.h"

namespace limn::measure {

/// How two masks of one size differ.
struct MaskChange {
  double area = 0.0;       ///< of the symmetric difference, square pixels
  double thickness = 0.0;  ///< of its thickest place, pixels: how far the outline moved there
};
/// The thickness is that of the strip between two straight outlines, from its horizontal and vertical extents h and v
/// through a point: h v / sqrt(h² + v²). Good to 1/8 pixel for a strip; a region as thick as it is long reads too small.
MaskChange changeBetween(const Mask& before, const Mask& after);

/// A camera path: along a circle of 20° latitude, from 30° of longitude on, in equal steps.
struct Path {
  double arcDegrees = 6.0, stepDegrees = 0.1;
  std::size_t steps() const;
  glm::dvec3 direction(std::size_t frame) const;  ///< of frame 0 … steps()
};

/// The largest changes of one method over a path.
struct Coherence {
  double change = 0.0;  ///< mean offset between consecutive frames, pixels: area / length of the true outline
  double trueChange = 0.0;  ///< the truth's own
  double pop = 0.0;         ///< largest of (change - the truth's change in the same step), not below 0
  double localPop = 0.0;    ///< the same of the thickest places
};

/// For every variant, in order.
std::vector<Coherence> measureCoherence(const Subject& subject, const std::vector<Variant>& variants,
                                        const Path& path, int size, Workers& workers);

}  // namespace limn::measure
