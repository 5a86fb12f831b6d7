#include "silhouette/crossing_kernel.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "silhouette/contour.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "silhouette/crossing_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, as Highway wants it.
#include <hwy/highway.h>
#include "silhouette/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::silhouette::HWY_NAMESPACE {

// What the root is found from, in floats; as many as one vector holds.
struct Ends {
  alignas(64) float height[2][16];
  alignas(64) float towards[2][3][16];
  alignas(64) float bent[2][3][16];  // n - 2 w
};

void keep(const Vector& v, float (&rows)[3][16]) {
  const Tag tag;
  hn::Store(v.x, tag, rows[0]);
  hn::Store(v.y, tag, rows[1]);
  hn::Store(v.z, tag, rows[2]);
}

// contourParameter of a vector of edges, step by step.
V parametersOf(const Ends& ends) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> half;
  using D = hn::Vec<decltype(d)>;
  const D zero = hn::Zero(d), one = hn::Set(d, 1.0), steepest = hn::Set(d, kSteepest);
  alignas(64) float parameters[16];
  for (std::size_t i = 0; i < hn::Lanes(Tag()); i += hn::Lanes(d)) {
    const auto wide = [&](const float* row) { return hn::PromoteTo(d, hn::LoadU(half, row + i)); };
    const auto product = [&](const float(&a)[3][16], const float(&b)[3][16]) {
      return hn::Add(hn::Add(hn::Mul(wide(a[0]), wide(b[0])), hn::Mul(wide(a[1]), wide(b[1]))),
                     hn::Mul(wide(a[2]), wide(b[2])));
    };
    const D a = hn::Neg(wide(ends.height[0])), c = hn::Neg(wide(ends.height[1]));
    const D free =
        hn::Neg(hn::Add(product(ends.towards[0], ends.bent[1]), product(ends.towards[1], ends.bent[0])));
    const D least = hn::Mul(steepest, hn::Min(a, c)), most = hn::Mul(steepest, hn::Max(a, c));
    const D b = hn::Min(hn::Max(free, least), most);
    const D root = hn::Sqrt(hn::Sub(hn::Mul(b, b), hn::Mul(hn::Mul(hn::Set(d, 4.0), a), c)));
    const auto falls = hn::Lt(b, zero), rises = hn::Gt(c, zero);
    const D q = hn::Mul(hn::Set(d, -0.5), hn::IfThenElse(falls, hn::Sub(b, root), hn::Add(b, root)));
    const auto first = hn::Not(hn::Xor(falls, rises));
    const D numerator = hn::Abs(hn::IfThenElse(first, q, a)),
            denominator = hn::Abs(hn::IfThenElse(first, c, q));
    D u = hn::Div(numerator, hn::Add(numerator, denominator));
    u = hn::IfThenElse(hn::Eq(denominator, zero), hn::IfThenElseZero(first, one), u);
    u = hn::IfThenElse(hn::IsFinite(hn::Add(hn::Sub(a, c), free)), u, hn::Set(d, 0.5));
    hn::StoreU(hn::DemoteTo(half, u), half, parameters + i);
  }
  return hn::Load(Tag(), parameters);
}

// normalTurn().
Vector turnOf(const Vector& p, const Vector& q, const Vector& np, const Vector& nq, const Vector& dp,
              const Vector& dq) {
  const Tag tag;
  const Vector along = add(subtract(q, p), multiply(hn::Set(tag, 0.75f), subtract(dq, dp)));
  const V length2 = dot(along, along);
  const V share = hn::Div(hn::Mul(hn::Set(tag, 0.5f), dot(add(np, nq), along)), length2);
  const auto tells = hn::Ge(length2, hn::Set(tag, kLeastSquare));
  const Vector turn = multiply(share, along);
  return {hn::IfThenElseZero(tells, turn.x), hn::IfThenElseZero(tells, turn.y),
          hn::IfThenElseZero(tells, turn.z)};
}

void crossingsAt(const View& view, const CrossedBatch& edges, std::size_t i, Crossings& crossings) {
  const Tag tag;
  const bool perspective = view.projection.perspective;
  const Vector p = load(edges, 0, i), q = load(edges, 1, i), np = load(edges, 2, i), nq = load(edges, 3, i);
  const Vector dp = load(edges, 4, i), dq = load(edges, 5, i), turn = turnOf(p, q, np, nq, dp, dq);
  const Vector eye = spread(view.eye), along = spread(-view.direction);
  const Vector towardsP = perspective ? subtract(eye, p) : along;
  const Vector towardsQ = perspective ? subtract(eye, q) : along;
  Ends ends;
  hn::Store(dot(np, towardsP), tag, ends.height[0]);
  hn::Store(dot(nq, towardsQ), tag, ends.height[1]);
  keep(towardsP, ends.towards[0]), keep(towardsQ, ends.towards[1]);
  const Vector doubled = multiply(hn::Set(tag, 2.0f), turn);
  keep(subtract(np, doubled), ends.bent[0]), keep(subtract(nq, doubled), ends.bent[1]);
  const V t = parametersOf(ends), s = hn::Sub(hn::Set(tag, 1.0f), t);
  const V hump = hn::Mul(hn::Mul(hn::Set(tag, 2.0f), s), t);
  const Vector normal = subtract(add(multiply(s, np), multiply(t, nq)), multiply(hump, turn));
  const V square = dot(normal, normal);
  // curvePoint().
  const Vector bend = add(multiply(s, dp), multiply(t, dq));
  const V share = hn::Mul(hn::Mul(hn::Set(tag, 3.0f), s), t);
  const Vector place = add(add(multiply(s, p), multiply(t, q)), multiply(share, bend));
  hn::StoreU(t, tag, crossings.parameters + i);
  hn::StoreU(square, tag, crossings.squares + i);
  store(place, crossings.vectors, 0, i);
  store(normal, crossings.vectors, 1, i);
  store(divide(normal, hn::Sqrt(square)), crossings.vectors, 2, i);
}

void crossingsOf(const View& view, const CrossedBatch& edges, Crossings& crossings) {
  for (std::size_t i = 0; i < edges.count; i += hn::Lanes(Tag())) crossingsAt(view, edges, i, crossings);
}

}  // namespace limn::silhouette::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::silhouette {

HWY_EXPORT(crossingsOf);

void computeCrossings(const View& view, const CrossedBatch& edges, Crossings& crossings) {
  HWY_DYNAMIC_DISPATCH(crossingsOf)(view, edges, crossings);
}

void computeCrossingsScalar(const View& view, const CrossedBatch& edges, Crossings& crossings) {
  crossings.vectors.count = 0;
  for (std::size_t i = 0; i < edges.count; ++i) {
    const std::array<glm::vec3, 2> p{edges.vector(0, i), edges.vector(1, i)},
        n{edges.vector(2, i), edges.vector(3, i)};
    const CurveOffsets d{edges.vector(4, i), edges.vector(5, i)};
    const glm::vec3 turn = normalTurn(p, n, d);
    const float t = contourParameter(view, p, n, turn);
    const glm::vec3 normal = bridgeNormal(n, turn, t);
    crossings.parameters[i] = t;
    crossings.squares[i] = glm::dot(normal, normal);
    crossings.vectors.add(curvePoint(p[0], p[1], d, t), normal, normal / std::sqrt(crossings.squares[i]));
  }
}

}  // namespace limn::silhouette
#endif
