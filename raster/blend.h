// Colours per sample, for pixels that something is blended over.
#pragma once

#include <glm/vec4.hpp>

#include "raster/tile.h"

namespace limn::raster {

/// Gives a pixel of the tile its colours per sample, if it has none yet: what is visible in it so far.
void openPixel(Tile& tile, int x, int y);

/// Source over: `under` is colour · alpha and alpha, `color` has straight alpha.
inline void blendOver(glm::vec4& under, const glm::vec4& color) {
  const float rest = 1.0F - color.w;
  under = {color.x * color.w + under.x * rest, color.y * color.w + under.y * rest,
           color.z * color.w + under.z * rest, color.w + under.w * rest};
}

}  // namespace limn::raster
