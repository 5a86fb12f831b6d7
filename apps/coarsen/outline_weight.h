// How much of the outline, over all directions of view, each part of a surface makes.
#pragma once

#include <vector>

#include "apps/coarsen/surface.h"
#include "raster/base/workers.h"

namespace limn::coarsen {

/// The outline's share per area at every point of the surface, relative to the surface's mean (so the mean over the area
/// is about 1), plus `floor` so that hidden parts keep a shape. The same for any number of threads.
std::vector<double> outlineWeights(const Surface& surface, double floor, Workers& workers);

}  // namespace limn::coarsen
