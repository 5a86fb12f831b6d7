#include "raster/kernels.h"

#include "raster/vector_kernels.h"

namespace limn::raster {

Kernels scalarKernels() {
  return {transformCluster, boxOfCluster, resolveVisibility, shadeTile};
}

Kernels vectorKernels() {
  Kernels kernels = scalarKernels();
  setTransformKernels(kernels);
  setVisibilityKernel(kernels);
  setShadingKernel(kernels);

  return kernels;
}

}  // namespace limn::raster
