// Where coverage is decided: the grid that vertices snap to, and the points of a pixel at which it is
// sampled.
//
// A vertex is moved to the nearest point of a grid of 1/256 pixel before anything is decided about coverage;
// from there on all is integer arithmetic without rounding. A sample is covered by a triangle when it lies
// inside, or on an edge that is a top edge (horizontal, the inside below it) or a left edge (the inside to
// the right of it).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "raster/base/check.h"

namespace limn::raster {

inline constexpr int kSubpixelBits = 8;
inline constexpr int kSubpixels = 1 << kSubpixelBits;  ///< grid steps per pixel

/// A sample's place in its pixel, in grid steps from the pixel's upper left corner, both in [0, kSubpixels).
struct SamplePosition {
  std::int32_t x, y;
};

inline constexpr std::array<SamplePosition, 1> kOneSample{{{128, 128}}};
inline constexpr std::array<SamplePosition, 4> kFourSamples{{{96, 32}, {224, 96}, {32, 160}, {160, 224}}};
inline constexpr std::array<SamplePosition, 8> kEightSamples{
    {{144, 80}, {112, 176}, {208, 144}, {80, 48}, {48, 208}, {16, 112}, {176, 240}, {240, 16}}};

/// The pattern of `samples` per pixel. 4 and 8 are the standard patterns of Direct3D 11: no two samples share
/// a row or a column, so that edges near the axes are graded. Throws std::invalid_argument for counts other
/// than 1, 4 and 8.
inline std::span<const SamplePosition> samplePattern(int samples) {
  require(samples == 1 || samples == 4 || samples == 8, "samples per pixel are 1, 4 or 8");
  if (samples == 1) return kOneSample;
  if (samples == 4) return kFourSamples;
  return kEightSamples;
}

}  // namespace limn::raster
