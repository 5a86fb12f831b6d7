// What drawing a frame takes, estimated before a pixel is drawn: a small hostile scene puts thousands of layers over the
// whole window, and is to be refused rather than drawn.
#pragma once

#include "raster/front_end.h"

namespace limn::raster {

/// Throws TooMuchEffort if the frame takes more than Frame::effortLimit. Depends on nothing but the frame: not on
/// threads, tiles or kernels. Frames far below the limit cost a look at each visible cluster.
void requireEffortWithinLimit(const Frame& frame, std::span<const Batch> batches, const FrontEnd& front,
                              const ScreenMap& map, const Tiling& tiling, const Kernels& kernels,
                              Workers& workers);

}  // namespace limn::raster
