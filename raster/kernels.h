// The functions of a frame that exist twice: in plain C++, as the definition of what is right, and as vector kernels
// for each instruction set. Both give the same bits; a frame asks for one table or the other once.
#pragma once

#include "raster/tile.h"

namespace limn::raster {

struct Kernels {
  void (*transformCluster)(const Batch&, const Cluster&, const ScreenMap&, VertexBlock&);
  Box (*boxOfCluster)(const Batch&, const Cluster&, const ScreenMap&);
  void (*resolveVisibility)(Tile&);
  void (*shadeTile)(Tile&);
};

Kernels scalarKernels();
/// For the best instruction set that the machine has, or hwy::SetSupportedTargetsForTest() leaves.
Kernels vectorKernels();

/// Visibility of one cluster of the tile, or one loose triangle, in plain C++: vector kernels leave alpha masks to it.
void drawClusterScalar(Tile& tile, std::uint32_t entry);
void drawLooseScalar(Tile& tile, std::uint32_t item);
/// Colour of one pixel of the tile, in plain C++: vector kernels leave to it what a vector cannot do as one.
void shadePixelScalar(Tile& tile, int x, int y);

}  // namespace limn::raster
