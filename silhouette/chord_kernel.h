// The pixel bound of many edge curves at a time.
#pragma once

#include <cstddef>

#include "silhouette/pixel_bound.h"
#include "silhouette/vector_batch.h"

namespace limn::silhouette {

/// p, q, d[0] and d[1] of curves.
using CurveBatch = VectorBatch<4>;

/// Of up to 64 curves.
struct CurveErrors {
  float bends[CurveBatch::kCapacity], chords[CurveBatch::kCapacity];

  CurveError operator[](std::size_t i) const { return {bends[i], chords[i]}; }
};

/// errors[i] = bound.curveError of curve i, to the last bit. The vector units of the machine do it.
void curveErrors(const PixelBound& bound, const CurveBatch& curves, CurveErrors& errors);

}  // namespace limn::silhouette
