// An exact rasterizer for tests: coverage decided by integers that cannot overflow, one sample and one
// triangle at a time.
//
// Based on: Edelsbrunner and Mücke, "Simulation of Simplicity", ACM Transactions on Graphics 9 (1990). The
// top-left fill rule is that scheme with the sample moved by (e, e²), e an infinitesimal, to the right and
// down: what lay on an edge is then strictly inside or outside. Differs from the rasterizer under test in
// everything: no tiles, no edge set-up, no classification of edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/samples.h"

namespace limn::test {

/// A point of the sub-pixel grid: 1/256 pixel from the window's upper left corner, y down.
struct GridPoint {
  std::int64_t x = 0, y = 0;
};

/// Front-facing where its corners run counter-clockwise on the screen.
struct GridTriangle {
  std::array<GridPoint, 3> corners;
  int depth = 1;  ///< of the whole triangle; the smaller is in front
};

/// Whether the triangle is front-facing, has an area and covers the sample.
bool covers(const GridTriangle& triangle, GridPoint sample);

/// What a rasterizer ought to find: per pixel the number of covered samples and the index of the nearest
/// triangle among all that cover a sample (kNoTriangle where none does).
struct ExactImage {
  int width = 0, height = 0;
  std::vector<int> coveredSamples;
  std::vector<std::uint32_t> nearest;
};
inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

ExactImage rasterizeExactly(std::span<const GridTriangle> triangles, int width, int height,
                            std::span<const raster::SamplePosition> pattern);

}  // namespace limn::test
