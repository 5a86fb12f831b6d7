// The material of a triangle at a point of it: what shading, alpha masks and blending share.
#pragma once

#include <glm/vec4.hpp>

#include "raster/texel.h"
#include "raster/tile.h"

namespace limn::raster {

/// Linear base colour and alpha: factor, vertex colour and texture. `at` is in window sub-pixels.
glm::vec4 baseColorAt(Tile& tile, Record& record, const Surface& surface, SamplePosition at);

/// What a record interpolates at a point besides normal and depth.
struct PointAttributes {
  glm::vec4 color;
  Footprint footprint;
};
PointAttributes attributesAt(Tile& tile, Record& record, SamplePosition at);

/// The colour that reaches the eye, and the material's alpha there (1 unless it is blended).
glm::vec4 shadeAt(Tile& tile, Record& record, SamplePosition at);

/// Where a pixel (from the tile's corner) of a triangle is shaded: at its centre if that is covered, else at the first
/// sample of the mask.
SamplePosition shadingPoint(const Tile& tile, const Corners& corners, unsigned mask, int x, int y);

}  // namespace limn::raster
