#include "raster/transform.h"

#include <algorithm>
#include <limits>

namespace limn::raster {

void transformCluster(const Batch& batch, const Cluster& cluster, const ScreenMap& map, VertexBlock& out) {
  for (std::uint32_t i = 0; i < cluster.vertexCount; ++i) {
    const ScreenVertex v = map.project(viewPosition(batch, cluster.firstVertex + i));
    const glm::vec3 n = viewNormal(batch, cluster.firstVertex + i);
    out.x[i] = v.x;
    out.y[i] = v.y;
    out.plane[i][0] = n.x * v.q;
    out.plane[i][1] = n.y * v.q;
    out.plane[i][2] = n.z * v.q;
    out.plane[i][3] = out.depth[i] = v.depth;
  }
}

Box boxOfCluster(const Batch& batch, const Cluster& cluster, const ScreenMap& map) {
  constexpr std::int32_t kLow = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t kHigh = std::numeric_limits<std::int32_t>::max();
  Box box{kHigh, kHigh, kLow, kLow};
  for (std::uint32_t i = 0; i < cluster.vertexCount; ++i) {
    const ScreenVertex v = map.project(viewPosition(batch, cluster.firstVertex + i));
    box.minX = std::min(box.minX, v.x), box.maxX = std::max(box.maxX, v.x);
    box.minY = std::min(box.minY, v.y), box.maxY = std::max(box.maxY, v.y);
  }
  return box;
}

}  // namespace limn::raster
