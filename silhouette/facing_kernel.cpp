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

// ⟨n, v⟩ of a vector of vertices at a time, over |v| or not. Sums are in the order of the scalar twins, and no products
// are fused.
template <bool kOverDistance>
void products(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
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
    V product = hn::Add(
        hn::Add(hn::Mul(x, hn::LoadU(tag, vertices.nx + i)), hn::Mul(y, hn::LoadU(tag, vertices.ny + i))),
        hn::Mul(z, hn::LoadU(tag, vertices.nz + i)));
    if constexpr (kOverDistance) {
      const V length2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
      product = hn::IfThenElseZero(hn::Gt(length2, zero), hn::Div(product, hn::Sqrt(length2)));
    }
    hn::StoreU(product, tag, out + i);
  }
  constexpr auto rest = kOverDistance ? computeFacingsScalar : computeHeightsScalar;
  rest(eye, perspective, vertices.from(i), count - i, out + i);
}

void heights(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
             float* out) {
  products<false>(eye, perspective, vertices, count, out);
}

void facings(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
             float* out) {
  products<true>(eye, perspective, vertices, count, out);
}

}  // namespace limn::silhouette::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::silhouette {
namespace {

template <bool kOverDistance>
void productsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = perspective ? eye.x - vertices.x[i] : eye.x;
    const float y = perspective ? eye.y - vertices.y[i] : eye.y;
    const float z = perspective ? eye.z - vertices.z[i] : eye.z;
    out[i] = x * vertices.nx[i] + y * vertices.ny[i] + z * vertices.nz[i];
    if constexpr (kOverDistance) {
      const float length2 = x * x + y * y + z * z;
      out[i] = length2 > 0.0f ? out[i] / std::sqrt(length2) : 0.0f;
    }
  }
}

}  // namespace

HWY_EXPORT(facings);
HWY_EXPORT(heights);

void computeHeights(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* out) {
  HWY_DYNAMIC_DISPATCH(heights)(eye, perspective, vertices, count, out);
}

void computeHeightsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices,
                          std::size_t count, float* heights) {
  productsScalar<false>(eye, perspective, vertices, count, heights);
}

void computeFacings(const glm::vec3& eye, bool perspective, const VertexArrays& vertices, std::size_t count,
                    float* facings) {
  HWY_DYNAMIC_DISPATCH(facings)(eye, perspective, vertices, count, facings);
}

void computeFacingsScalar(const glm::vec3& eye, bool perspective, const VertexArrays& vertices,
                          std::size_t count, float* facings) {
  productsScalar<true>(eye, perspective, vertices, count, facings);
}

}  // namespace limn::silhouette
#endif
