// Fits the control points of a patch net to a surface.
#pragma once

#include <functional>
#include <vector>

#include "apps/coarsen/patch_net.h"
#include "raster/base/workers.h"

namespace limn::coarsen {

struct FitSettings {
  int rounds = 8;
  bool moveCorners = true;
};

/// Least squares, weighted by `weights` (one per point of the surface, outlineWeights()). Starts from the net as it is.
/// The same for any number of threads. `progress` is called after every round.
void fitPatches(const Surface& surface, const std::vector<double>& weights, const FitSettings& settings,
                Workers& workers, PatchNet& net, const std::function<void(int)>& progress = {});

}  // namespace limn::coarsen
