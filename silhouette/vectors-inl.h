// Vectors in space, a machine vector of them at a time, with the operations in the order in which glm has them.
#if defined(LIMN_SILHOUETTE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_SILHOUETTE_VECTORS_INL_H_
#undef LIMN_SILHOUETTE_VECTORS_INL_H_
#else
#define LIMN_SILHOUETTE_VECTORS_INL_H_
#endif

#include "hwy/highway.h"
#include "silhouette/vector_batch.h"

HWY_BEFORE_NAMESPACE();
namespace limn::silhouette {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using V = hn::Vec<Tag>;

struct Vector {
  V x, y, z;
};

HWY_INLINE Vector add(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector subtract(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector multiply(const V& s, const Vector& v) {
  return {hn::Mul(s, v.x), hn::Mul(s, v.y), hn::Mul(s, v.z)};
}
HWY_INLINE Vector divide(const Vector& v, const V& s) {
  return {hn::Div(v.x, s), hn::Div(v.y, s), hn::Div(v.z, s)};
}
HWY_INLINE V dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector spread(const glm::vec3& v) {
  const Tag tag;
  return {hn::Set(tag, v.x), hn::Set(tag, v.y), hn::Set(tag, v.z)};
}

// Vector `k` of a batch, of the things from `i` on.
template <std::size_t kVectors>
HWY_INLINE Vector load(const VectorBatch<kVectors>& batch, std::size_t k, std::size_t i) {
  const Tag tag;
  return {hn::LoadU(tag, batch.coordinates[3 * k] + i), hn::LoadU(tag, batch.coordinates[3 * k + 1] + i),
          hn::LoadU(tag, batch.coordinates[3 * k + 2] + i)};
}
template <std::size_t kVectors>
HWY_INLINE void store(const Vector& v, VectorBatch<kVectors>& batch, std::size_t k, std::size_t i) {
  const Tag tag;
  hn::StoreU(v.x, tag, batch.coordinates[3 * k] + i);
  hn::StoreU(v.y, tag, batch.coordinates[3 * k + 1] + i);
  hn::StoreU(v.z, tag, batch.coordinates[3 * k + 2] + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace limn::silhouette
HWY_AFTER_NAMESPACE();
#endif
