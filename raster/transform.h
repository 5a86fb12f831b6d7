// A cluster's vertices on the sub-pixel grid, with what its triangles interpolate.
#pragma once

#include <cstdint>

#include "raster/batch.h"

namespace limn::raster {

/// The window coordinates, view-space unit normals times q, and depths of a cluster's vertices.
struct VertexBlock {
  alignas(64) std::int32_t x[kClusterVertices], y[kClusterVertices];
  alignas(64) float depth[kClusterVertices];
  alignas(64) float plane[kClusterVertices][4];  ///< normal · q (x, y, z), depth
  float texcoord[kClusterVertices][2];           ///< times q; see setTexcoords()
};

/// Box of window coordinates in sub-pixels, bounds included.
struct Box {
  std::int32_t minX, minY, maxX, maxY;
};

/// View-space position of a cluster's vertex.
inline glm::vec3 viewPosition(const Batch& batch, std::uint32_t i) {
  return batch.toView(batch.points->x[i], batch.points->y[i], batch.points->z[i]);
}

/// View-space unit normal of a cluster's vertex; 0 stays 0.
inline glm::vec3 viewNormal(const Batch& batch, std::uint32_t i) {
  const ClusterVertices& p = *batch.points;
  const auto row = [&](int k) {
    const float* r = batch.normalRows[k];
    return (r[0] * p.nx[i] + r[1] * p.ny[i]) + r[2] * p.nz[i];
  };
  const float x = row(0), y = row(1), z = row(2);
  const float square = (x * x + y * y) + z * z;
  const float inverse = 1.0F / std::sqrt(std::max(square, 1e-37F));
  return {x * inverse, y * inverse, z * inverse};
}

/// All vertices of a cluster; each must lie beyond the near plane and within the guard band.
void transformCluster(const Batch& batch, const Cluster& cluster, const ScreenMap& map, VertexBlock& out);

/// Box of a cluster's window coordinates.
Box boxOfCluster(const Batch& batch, const Cluster& cluster, const ScreenMap& map);

}  // namespace limn::raster
