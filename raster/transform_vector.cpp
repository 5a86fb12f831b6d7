// The vertices of a cluster, a vector at a time. Definition: transform.cpp.
#include "raster/kernels.h"
#include "raster/vector_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/transform_vector.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
void transformClusterVector(const Batch& batch, const Cluster& cluster, const ScreenMap& map,
                            VertexBlock& out) {
  transformCluster(batch, cluster, map, out);
}
Box boxOfClusterVector(const Batch& batch, const Cluster& cluster, const ScreenMap& map) {
  return boxOfCluster(batch, cluster, map);
}
#else
// ((m0·x + m1·y) + m2·z) + m3
inline VF rowOf(const float* m, VF x, VF y, VF z) {
  const F f;
  const VF sum = hn::Add(hn::Add(hn::Mul(hn::Set(f, m[0]), x), hn::Mul(hn::Set(f, m[1]), y)),
                         hn::Mul(hn::Set(f, m[2]), z));
  return hn::Add(sum, hn::Set(f, m[3]));
}

inline VF rowOf3(const float* m, VF x, VF y, VF z) {
  const F f;
  return hn::Add(hn::Add(hn::Mul(hn::Set(f, m[0]), x), hn::Mul(hn::Set(f, m[1]), y)),
                 hn::Mul(hn::Set(f, m[2]), z));
}

struct Projected {
  VI x, y;
  VF depth, q;
};

// ScreenMap::project of N vertices.
inline Projected projectAt(const Batch& batch, std::size_t i, const ScreenMap& map) {
  const F f;
  const I d;
  const ClusterVertices& p = *batch.points;
  const VF mx = hn::LoadU(f, &p.x[i]), my = hn::LoadU(f, &p.y[i]), mz = hn::LoadU(f, &p.z[i]);
  const VF x = rowOf(batch.toView.m[0], mx, my, mz), y = rowOf(batch.toView.m[1], mx, my, mz);
  const VF z = rowOf(batch.toView.m[2], mx, my, mz), one = hn::Set(f, 1.0F);
  const VF q = map.perspective ? hn::Div(one, hn::Neg(z)) : one;
  const VF sx = hn::Floor(hn::Add(hn::Mul(hn::Mul(x, q), hn::Set(f, map.scaleX)), hn::Set(f, map.offsetX)));
  const VF sy = hn::Floor(hn::Add(hn::Mul(hn::Mul(y, q), hn::Set(f, map.scaleY)), hn::Set(f, map.offsetY)));
  const VF depth =
      map.perspective ? q : hn::Add(hn::Mul(z, hn::Set(f, map.depthScale)), hn::Set(f, map.depthOffset));
  return {hn::ConvertTo(d, sx), hn::ConvertTo(d, sy), depth, q};
}

void transformClusterVector(const Batch& batch, const Cluster& cluster, const ScreenMap& map,
                            VertexBlock& out) {
  const F f;
  const I d;
  const ClusterVertices& p = *batch.points;
  for (std::size_t i = 0; i < cluster.vertexCount; i += hn::Lanes(f)) {
    const std::size_t from = cluster.firstVertex + i;
    const Projected v = projectAt(batch, from, map);
    const VF nx = hn::LoadU(f, &p.nx[from]), ny = hn::LoadU(f, &p.ny[from]), nz = hn::LoadU(f, &p.nz[from]);
    const VF x = rowOf3(batch.normalRows[0], nx, ny, nz), y = rowOf3(batch.normalRows[1], nx, ny, nz);
    const VF z = rowOf3(batch.normalRows[2], nx, ny, nz);
    const VF square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const VF inverse = hn::Div(hn::Set(f, 1.0F), hn::Sqrt(hn::Max(square, hn::Set(f, 1e-37F))));
    hn::Store(v.x, d, out.x + i);
    hn::Store(v.y, d, out.y + i);
    hn::Store(v.depth, f, out.depth + i);
    hn::StoreInterleaved4(hn::Mul(hn::Mul(x, inverse), v.q), hn::Mul(hn::Mul(y, inverse), v.q),
                          hn::Mul(hn::Mul(z, inverse), v.q), v.depth, f, out.plane[i]);
  }
}

Box boxOfClusterVector(const Batch& batch, const Cluster& cluster, const ScreenMap& map) {
  const F f;
  const I d;
  VI minX = hn::Set(d, hwy::HighestValue<std::int32_t>()), minY = minX;
  VI maxX = hn::Set(d, hwy::LowestValue<std::int32_t>()), maxY = maxX;
  for (std::size_t i = 0; i < cluster.vertexCount; i += hn::Lanes(f)) {
    const Projected v = projectAt(batch, cluster.firstVertex + i, map);
    const auto mine = hn::FirstN(d, cluster.vertexCount - i);
    minX = hn::IfThenElse(mine, hn::Min(minX, v.x), minX);
    minY = hn::IfThenElse(mine, hn::Min(minY, v.y), minY);
    maxX = hn::IfThenElse(mine, hn::Max(maxX, v.x), maxX);
    maxY = hn::IfThenElse(mine, hn::Max(maxY, v.y), maxY);
  }
  return {hn::GetLane(hn::MinOfLanes(d, minX)), hn::GetLane(hn::MinOfLanes(d, minY)),
          hn::GetLane(hn::MaxOfLanes(d, maxX)), hn::GetLane(hn::MaxOfLanes(d, maxY))};
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::raster {
HWY_EXPORT(transformClusterVector);
HWY_EXPORT(boxOfClusterVector);
namespace {
void transform(const Batch& batch, const Cluster& cluster, const ScreenMap& map, VertexBlock& out) {
  HWY_DYNAMIC_DISPATCH(transformClusterVector)(batch, cluster, map, out);
}
Box box(const Batch& batch, const Cluster& cluster, const ScreenMap& map) {
  return HWY_DYNAMIC_DISPATCH(boxOfClusterVector)(batch, cluster, map);
}
}  // namespace
void setTransformKernels(Kernels& kernels) {
  kernels.transformCluster = transform;
  kernels.boxOfCluster = box;
}
}  // namespace limn::raster
#endif
