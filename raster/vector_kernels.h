// Each file of vector kernels fills in its part of the table.
#pragma once

#include "raster/kernels.h"

namespace limn::raster {

void setTransformKernels(Kernels& kernels);
void setVisibilityKernel(Kernels& kernels);
void setShadingKernel(Kernels& kernels);

}  // namespace limn::raster
