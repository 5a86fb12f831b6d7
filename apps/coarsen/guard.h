// What a fit may not do: fold a patch, or leave the surface by more than a stated distance.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/coarsen/patch_net.h"
#include "raster/base/workers.h"

namespace limn::coarsen {

struct GuardReport {
  double limit = 0.0;            ///< the stated distance, or a flat triangle's own where that is larger
  double farthest = 0.0;         ///< of all patches from the surface, after mending
  std::size_t mended = 0;        ///< patches that had to be drawn towards their flat triangles
  std::size_t straightened = 0;  ///< of those, drawn flat
};

/// Largest distance of the patches from the surface, relative to half the diagonal of its bounds.
inline constexpr double kFarthestPatch = 0.02;

/// Draws patches that fold, or leave the surface by more than kFarthestPatch, towards their flat triangles until none does.
GuardReport guardPatches(const Surface& surface, Workers& workers, PatchNet& net);

}  // namespace limn::coarsen
