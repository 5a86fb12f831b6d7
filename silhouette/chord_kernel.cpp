#include "silhouette/chord_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "silhouette/chord_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, as Highway wants it.
#include <hwy/highway.h>
#include "silhouette/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::silhouette::HWY_NAMESPACE {
// Column by column, as glm multiplies.
Vector apply(const glm::mat3& m, const Vector& v) {
  const Tag tag;
  const auto row = [&](int r) {
    const V sum = hn::Add(hn::Mul(hn::Set(tag, m[0][r]), v.x), hn::Mul(hn::Set(tag, m[1][r]), v.y));
    return hn::Add(sum, hn::Mul(hn::Set(tag, m[2][r]), v.z));
  };
  return {row(0), row(1), row(2)};
}

V squareInPlane(const V& x, const V& y) {
  return hn::Add(hn::Mul(x, x), hn::Mul(y, y));
}

// The squares of PixelBound::curveError.
struct Squares {
  V bend, middle, turn;

  void widen(const V& x1, const V& y1, const V& x2, const V& y2) {
    const V half = hn::Set(Tag(), 0.5f);
    bend = hn::Max(bend, hn::Max(squareInPlane(x1, y1), squareInPlane(x2, y2)));
    middle = hn::Max(middle, squareInPlane(hn::Mul(half, hn::Add(x1, x2)), hn::Mul(half, hn::Add(y1, y2))));
    turn = hn::Max(turn, squareInPlane(hn::Sub(x2, x1), hn::Sub(y2, y1)));
  }
};

// PixelBound::curveError of one vector of curves, step by step.
void errorsAt(const PixelMap& map, const CurveBatch& curves, std::size_t i, CurveErrors& errors) {
  const Tag tag;
  const V two = hn::Set(tag, 2.0f);
  const Vector d0 = apply(map.linear, load(curves, 2, i)), d1 = apply(map.linear, load(curves, 3, i));
  const Vector first = subtract(d1, multiply(two, d0)), second = subtract(d0, multiply(two, d1));
  Squares squares{hn::Zero(tag), hn::Zero(tag), hn::Zero(tag)};
  V nearest = hn::Set(tag, 1.0f);
  if (map.perspective) {
    const Vector origin = spread(map.origin);
    const Vector start = add(apply(map.linear, load(curves, 0, i)), origin),
                 end = add(apply(map.linear, load(curves, 1, i)), origin);
    const Vector third = divide(subtract(end, start), hn::Set(tag, 3.0f));
    const Vector control[4] = {start, add(add(start, third), d0), add(subtract(end, third), d1), end};
    const V nearPlane = hn::Set(tag, map.nearPlane);
    nearest = hn::Min(hn::Min(control[0].z, control[1].z), hn::Min(control[2].z, control[3].z));
    nearest = hn::Max(nearest, nearPlane);
    for (const Vector& b : control) {
      const V inverse = hn::Div(hn::Set(tag, 1.0f), hn::Max(b.z, nearPlane));
      const V sx = hn::Mul(b.x, inverse), sy = hn::Mul(b.y, inverse);
      squares.widen(hn::Sub(first.x, hn::Mul(first.z, sx)), hn::Sub(first.y, hn::Mul(first.z, sy)),
                    hn::Sub(second.x, hn::Mul(second.z, sx)), hn::Sub(second.y, hn::Mul(second.z, sy)));
    }
  } else {
    squares.widen(first.x, first.y, second.x, second.y);
  }
  const V factor = hn::Set(tag, PixelMap::kChordFactor), turnFactor = hn::Set(tag, PixelMap::kTurnFactor);
  const V bend = hn::Div(hn::Mul(factor, hn::Sqrt(squares.bend)), nearest);
  const V chord =
      hn::Div(hn::Add(hn::Mul(factor, hn::Sqrt(squares.middle)), hn::Mul(turnFactor, hn::Sqrt(squares.turn))),
              nearest);
  hn::StoreU(bend, tag, errors.bends + i);
  hn::StoreU(hn::Min(bend, chord), tag, errors.chords + i);
}

void errorsOf(const PixelMap& map, const CurveBatch& curves, CurveErrors& errors) {
  for (std::size_t i = 0; i < curves.count; i += hn::Lanes(Tag())) errorsAt(map, curves, i, errors);
}

}  // namespace limn::silhouette::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::silhouette {

HWY_EXPORT(errorsOf);

void curveErrors(const PixelBound& bound, const CurveBatch& curves, CurveErrors& errors) {
  HWY_DYNAMIC_DISPATCH(errorsOf)(bound.map(), curves, errors);
}

}  // namespace limn::silhouette
#endif
