// Texture coordinates and vertex colours of a vector of pixels. Definition: Interpolator of surface.cpp.
//
// A vector of pixels often shows several triangles. Each of them only puts the numbers of its planes into its lanes;
// what they amount to is computed once.
#if defined(LIMN_RASTER_ATTRIBUTES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_ATTRIBUTES_INL_H_
#undef LIMN_RASTER_ATTRIBUTES_INL_H_
#else
#define LIMN_RASTER_ATTRIBUTES_INL_H_
#endif

#include "raster/texel-inl.h"
#include "raster/tile.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// Texture coordinates alone, where Tile::texturedMaterial has set their planes aside.
class TexcoordVector {
 public:
  HWY_INLINE TexcoordVector() : x0_(hn::Zero(I())), y0_(hn::Zero(I())) {
    for (VF* plane : {origin_, slopeX_, slopeY_, slopeQ_}) plane[0] = plane[1] = hn::Zero(F());
  }

  /// The planes of each lane's own record.
  HWY_INLINE TexcoordVector(const TexturePlanes* planes, const std::int32_t* ids) {
    const F f;
    const I d;
    VF rows[4], more[4];
    VI anchors[4], unused[2];
    forEach(std::make_index_sequence<4>(), [&](auto j) HWY_ATTR {
      rows[j] = loadEveryFourth(f, j, [&](std::size_t lane) { return planes[ids[lane]].origin; });
      more[j] = loadEveryFourth(f, j, [&](std::size_t lane) { return planes[ids[lane]].slopeY; });
      anchors[j] = loadEveryFourth(d, j, [&](std::size_t lane) { return &planes[ids[lane]].x0; });
    });
    transpose(f, rows, origin_[0], origin_[1], slopeX_[0], slopeX_[1]);
    transpose(f, more, slopeY_[0], slopeY_[1], slopeQ_[0], slopeQ_[1]);
    transpose(d, anchors, x0_, y0_, unused[0], unused[1]);
  }

  /// Takes a triangle's planes into the lanes `where`.
  HWY_INLINE void set(const TexturePlanes& p, MI where) {
    const F f;
    const I d;
    const MF lanes = hn::RebindMask(f, where);
    const auto put = [&](VF& to, float value) HWY_ATTR { to = hn::IfThenElse(lanes, hn::Set(f, value), to); };
    for (int i = 0; i < 2; ++i) {
      put(origin_[i], p.origin[i]), put(slopeX_[i], p.slopeX[i]), put(slopeY_[i], p.slopeY[i]);
      put(slopeQ_[i], p.slopeQ[i]);
    }
    x0_ = hn::IfThenElse(where, hn::Set(d, p.x0), x0_);
    y0_ = hn::IfThenElse(where, hn::Set(d, p.y0), y0_);
  }

  /// At the sub-pixels (px, py), where the points' distances are `w`: coordinates and level of detail.
  HWY_INLINE void store(const Texture::Data& texture, VI px, VI py, VF w, TextureBatch& batch,
                        std::size_t i) const {
    const F f;
    const VF dx = hn::ConvertTo(f, hn::Sub(px, x0_)), dy = hn::ConvertTo(f, hn::Sub(py, y0_));
    const auto at = [&](int k) HWY_ATTR {
      return hn::Mul(hn::Add(hn::Add(origin_[k], hn::Mul(slopeY_[k], dy)), hn::Mul(slopeX_[k], dx)), w);
    };
    const VF u = at(0), v = at(1), scale = hn::Mul(w, hn::Set(f, static_cast<float>(kSubpixels)));
    const auto change = [&](VF slope, VF value, VF q)
                            HWY_ATTR { return hn::Mul(hn::Sub(slope, hn::Mul(value, q)), scale); };
    const FootprintVector footprint{u,
                                    v,
                                    change(slopeX_[0], u, slopeQ_[0]),
                                    change(slopeX_[1], v, slopeQ_[0]),
                                    change(slopeY_[0], u, slopeQ_[1]),
                                    change(slopeY_[1], v, slopeQ_[1])};
    storeFootprint(texture, footprint, batch, i);
  }

 private:
  VF origin_[2], slopeX_[2], slopeY_[2], slopeQ_[2];
  VI x0_, y0_;
};

class AttributeVector {
 public:
  HWY_INLINE AttributeVector() : x0_(hn::Zero(I())), colored_(hn::FirstN(F(), 0)) {
    const VF zero = hn::Zero(F());
    for (Plane* plane : {&u_, &v_, &color_[0], &color_[1], &color_[2]}) plane->start = plane->slopeX = zero;
    slopeYOfU_ = slopeYOfV_ = qx_ = qy_ = zero;
  }

  /// Takes a triangle's planes along row `py` (sub-pixels) into the lanes `where`.
  HWY_INLINE void set(const Record& record, const Attributes& a, bool textured, bool colored, std::int32_t py,
                      MF where) {
    const F f;
    const I d;
    const auto put = [&](VF& to, float value) { to = hn::IfThenElse(where, hn::Set(f, value), to); };
    const float rise = static_cast<float>(py - record.y0);
    const auto putPlane = [&](Plane& to, int i) {
      put(to.start, a.origin[i] + a.slopeY[i] * rise);
      put(to.slopeX, a.slopeX[i]);
    };
    x0_ = hn::IfThenElse(hn::RebindMask(d, where), hn::Set(d, record.x0), x0_);
    if (colored) {
      colored_ = hn::Or(colored_, where);
      for (int k = 0; k < 3; ++k) putPlane(color_[k], Attributes::kRed + k);
    }
    if (!textured) return;
    putPlane(u_, Attributes::kU), putPlane(v_, Attributes::kV);
    put(slopeYOfU_, a.slopeY[Attributes::kU]), put(slopeYOfV_, a.slopeY[Attributes::kV]);
    put(qx_, record.slopeX[3]), put(qy_, record.slopeY[3]);
  }

  /// At the sub-pixel columns `px`, where the points' distances are `w`; 1 where a triangle has no colours.
  HWY_INLINE Color color(VI px, VF w) const {
    const VF one = hn::Set(F(), 1.0F);
    if (hn::AllFalse(F(), colored_)) return {one, one, one};
    const VF dx = hn::ConvertTo(F(), hn::Sub(px, x0_));
    const auto channel = [&](int k) { return hn::IfThenElse(colored_, color_[k].at(dx, w), one); };
    return {channel(0), channel(1), channel(2)};
  }

  HWY_INLINE FootprintVector footprint(VI px, VF w, bool perspective) const {
    const F f;
    const VF dx = hn::ConvertTo(f, hn::Sub(px, x0_)), zero = hn::Zero(f);
    const VF u = u_.at(dx, w), v = v_.at(dx, w), qx = perspective ? qx_ : zero, qy = perspective ? qy_ : zero;
    const VF scale = hn::Mul(w, hn::Set(f, static_cast<float>(kSubpixels)));
    const auto change = [&](VF slope, VF at, VF q) { return hn::Mul(hn::Sub(slope, hn::Mul(at, q)), scale); };
    return {u,
            v,
            change(u_.slopeX, u, qx),
            change(v_.slopeX, v, qx),
            change(slopeYOfU_, u, qy),
            change(slopeYOfV_, v, qy)};
  }

 private:
  // Along the row.
  struct Plane {
    VF start, slopeX;
    HWY_INLINE VF at(VF dx, VF w) const { return hn::Mul(hn::Add(start, hn::Mul(slopeX, dx)), w); }
  };

  VI x0_;
  Plane u_, v_, color_[3];
  VF slopeYOfU_, slopeYOfV_, qx_, qy_;
  MF colored_;
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
