#include "silhouette/facing_kernel.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "silhouette/facing_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, as Highway wants it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace limn::silhouette::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// ⟨n, v⟩ of one vector of vertices. Sums are in the order of the scalar twins, and no products are fused.
void heights(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
             float* out) {
  const hn::ScalableTag<float> tag;
  using V = hn::Vec<decltype(tag)>;
  const std::size_t lanes = hn::Lanes(tag);
  const V ex = hn::Set(tag, eye.x), ey = hn::Set(tag, eye.y), ez = hn::Set(tag, eye.z);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    V x = ex, y = ey, z = ez;
    if (perspective) {
      x = hn::Sub(ex, hn::LoadU(tag, vertices.x + i));
      y = hn::Sub(ey, hn::LoadU(tag, vertices.y + i));
      z = hn::Sub(ez, hn::LoadU(tag, vertices.z + i));
    }
    hn::StoreU(hn::Add(hn::Add(hn::Mul(x, hn::LoadU(tag, vertices.nx + i)),
                               hn::Mul(y, hn::LoadU(tag, vertices.ny + i))),
                       hn::Mul(z, hn::LoadU(tag, vertices.nz + i))),
               tag, out + i);
  }
  computeHeightsScalar(eye, perspective, vertices.from(i), count - i, out + i);
}

// One vector of vertices at a time, likewise.
void facings(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
             float* out) {
  const hn::ScalableTag<float> tag;
  using V = hn::Vec<decltype(tag)>;
  const std::size_t lanes = hn::Lanes(tag);
  const V ex = hn::Set(tag, eye.x), ey = hn::Set(tag, eye.y), ez = hn::Set(tag, eye.z), zero = hn::Zero(tag);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    V x = ex, y = ey, z = ez;
    if (perspective) {
      x = hn::Sub(ex, hn::LoadU(tag, vertices.x + i));
      y = hn::Sub(ey, hn::LoadU(tag, vertices.y + i));
      z = hn::Sub(ez, hn::LoadU(tag, vertices.z + i));
    }
    const V length2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const V product = hn::Add(
        hn::Add(hn::Mul(x, hn::LoadU(tag, vertices.nx + i)), hn::Mul(y, hn::LoadU(tag, vertices.ny + i))),
        hn::Mul(z, hn::LoadU(tag, vertices.nz + i)));
    const V facing = hn::Div(product, hn::Sqrt(length2));
    hn::StoreU(hn::IfThenElse(hn::Gt(length2, zero), facing, zero), tag, out + i);
  }
  computeFacingsScalar(eye, perspective, vertices.from(i), count - i, out + i);
}

}  // namespace limn::silhouette::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::silhouette {

HWY_EXPORT(facings);
HWY_EXPORT(heights);

void computeHeights(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* out) {
  HWY_DYNAMIC_DISPATCH(heights)(eye, perspective, vertices, count, out);
}

void computeHeightsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices,
                          std::size_t count, float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = perspective ? eye.x - vertices.x[i] : eye.x;
    const float y = perspective ? eye.y - vertices.y[i] : eye.y;
    const float z = perspective ? eye.z - vertices.z[i] : eye.z;
    out[i] = x * vertices.nx[i] + y * vertices.ny[i] + z * vertices.nz[i];
  }
}

void computeFacings(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* facings) {
  HWY_DYNAMIC_DISPATCH(facings)(eye, perspective, vertices, count, facings);
}

void computeFacingsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices,
                          std::size_t count, float* facings) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = perspective ? eye.x - vertices.x[i] : eye.x;
    const float y = perspective ? eye.y - vertices.y[i] : eye.y;
    const float z = perspective ? eye.z - vertices.z[i] : eye.z;
    const float length2 = x * x + y * y + z * z;
    const float product = x * vertices.nx[i] + y * vertices.ny[i] + z * vertices.nz[i];
    facings[i] = length2 > 0.0f ? product / std::sqrt(length2) : 0.0f;
  }
}

}  // namespace limn::silhouette
#endif
