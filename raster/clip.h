// Triangles that are drawn one by one instead of with their cluster: those that had to be clipped, and
// blended ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "raster/transform.h"
#include "raster/triangle.h"

namespace limn::raster {

/// Where a triangle comes from.
struct TriangleRef {
  std::uint32_t batch;
  std::uint32_t cluster;   ///< of the batch's set
  std::uint32_t triangle;  ///< of the cluster
};

struct LooseTriangle {
  Corners corners;
  bool cut;              ///< planes are given at `anchors`, else at the corners
  Corners anchors;       ///< of positive area, within the window
  float plane[3][4];     ///< as VertexBlock::plane
  glm::vec3 weights[3];  ///< of the corners of the triangle it comes from, times q
  TriangleRef ref;
};

/// Of the three corners.
inline Box boxOf(const Corners& c) {
  const auto [minX, maxX] = std::minmax({c.x[0], c.x[1], c.x[2]});
  const auto [minY, maxY] = std::minmax({c.y[0], c.y[1], c.y[2]});
  return {minX, minY, maxX, maxY};
}

/// Appends the parts of a triangle that lie between the near and the far plane and within the guard band. A triangle
/// with a corner that is not finite in view space has none.
void clipTriangle(const Batch& batch, const TriangleRef& ref, const ScreenMap& map,
                  std::vector<LooseTriangle>& out);

}  // namespace limn::raster
