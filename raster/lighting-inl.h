// Lighting and encoding a vector of points at a time. Definition: lighting.h and encode.h.
#if defined(LIMN_RASTER_LIGHTING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_LIGHTING_INL_H_
#undef LIMN_RASTER_LIGHTING_INL_H_
#else
#define LIMN_RASTER_LIGHTING_INL_H_
#endif

#include "raster/lighting.h"
#include "raster/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

/// Points to be shaded, up to `count`: rayAt() of their places in the window, normals, depths where lights need them,
/// base colours; their colours; and what the steps of lighting hand on.
struct PointBatch {
  static constexpr std::size_t kSize = 256;
  alignas(64) float rayX[kSize], rayY[kSize], normal[3][kSize], depth[kSize], base[3][kSize];
  alignas(64) float color[3][kSize];
  alignas(64) float length[kSize], diffuse[kSize], shine[kSize];
  std::size_t count = 0;
};

struct Color {
  VF r, g, b;
};

/// power() of lighting.h, n >= 0.
HWY_INLINE VF powerOf(VF x, int n) {
  if (n == 0) return hn::Set(F(), 1.0F);
  for (; (n & 1) == 0; n >>= 1) x = hn::Mul(x, x);
  VF result = x;
  while ((n >>= 1) != 0) {
    x = hn::Mul(x, x);
    if ((n & 1) != 0) result = hn::Mul(result, x);
  }
  return result;
}

class Lighting {
 public:
  Lighting(const ScreenMap& map, std::span<const Light> lights) : map_(map), lights_(lights) {
    for (const Light& light : lights) needsDepth_ |= light.kind != Light::Kind::kDirectional;
  }

  /// rayAt() of lighting.h, for sub-pixels of the window.
  HWY_INLINE VF rayX(VI px) const {
    const VI center = hn::Set(I(), map_.width * (kSubpixels / 2));
    return hn::Mul(hn::ConvertTo(F(), hn::Sub(px, center)), hn::Set(F(), map_.rayX));
  }
  HWY_INLINE VF rayY(VI py) const {
    const VI center = hn::Set(I(), map_.height * (kSubpixels / 2));
    return hn::Mul(hn::ConvertTo(F(), hn::Sub(center, py)), hn::Set(F(), map_.rayY));
  }

  /// Some light shines from a place: points need their depths.
  bool needsDepth() const { return needsDepth_; }

  /// litColor() with the material's own emission.
  void operator()(PointBatch& p, const Material& m) const {
    const F f;
    for (std::size_t i = 0; i < p.count; i += kLanes) hn::Store(eyeLength(p, i), f, p.length + i);
    // Sums begin with what need not be added.
    bool first = m.emissive.x == 0.0F && m.emissive.y == 0.0F && m.emissive.z == 0.0F;
    if (!first || lights_.empty())
      for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < p.count; i += kLanes)
          hn::Store(hn::Set(f, m.emissive[k]), f, p.color[k] + i);
    for (const Light& light : lights_) {
      if (light.kind == Light::Kind::kDirectional)
        setShares<true>(light, m, p);
      else
        setShares<false>(light, m, p);
      const bool white = light.color.x == 1.0F && light.color.y == 1.0F && light.color.z == 1.0F;
      if (white && first)
        addColors<true, true>(light, m, p);
      else if (first)
        addColors<false, true>(light, m, p);
      else
        addColors<false, false>(light, m, p);
      first = false;
    }
  }

 private:
  HWY_INLINE VF eyeLength(const PointBatch& p, std::size_t i) const {
    const F f;
    const VF one = hn::Set(f, 1.0F), x = hn::Load(f, p.rayX + i), y = hn::Load(f, p.rayY + i);
    return map_.perspective ? hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), one)) : one;
  }

  // How much of a light the points' bases and highlights send on.
  template <bool kDirectional>
  HWY_INLINE void setShares(const Light& light, const Material& m, PointBatch& p) const {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    const VF ambient = hn::Set(f, light.ambient), diffuse = hn::Set(f, light.diffuse);
    const bool perspective = map_.perspective, odd = (m.shininess & 1) != 0;
    const int half = m.shininess >> 1;
    Incoming in{hn::Set(f, light.toLight.x), hn::Set(f, light.toLight.y), hn::Set(f, light.toLight.z), one};
    for (std::size_t i = 0; i < p.count; i += kLanes) {
      const VF nx = hn::Load(f, p.normal[0] + i), ny = hn::Load(f, p.normal[1] + i),
               nz = hn::Load(f, p.normal[2] + i), length = hn::Load(f, p.length + i);
      // The vector to the eye is (-x, -y, 1).
      const VF x = perspective ? hn::Load(f, p.rayX + i) : zero,
               y = perspective ? hn::Load(f, p.rayY + i) : zero;
      if constexpr (!kDirectional) in = incoming(light, placeOf(p, i));
      const VF nn = hn::Max(dot3(nx, nx, ny, ny, nz, nz), hn::Set(f, 1e-37F));
      const VF nv = hn::Sub(nz, hn::Add(hn::Mul(nx, x), hn::Mul(ny, y)));
      const VF ln = dot3(nx, in.x, ny, in.y, nz, in.z);
      const VF lv = hn::Sub(in.z, hn::Add(hn::Mul(in.x, x), hn::Mul(in.y, y)));
      const VF hh = hn::Max(hn::Mul(hn::Add(length, length), hn::Add(length, lv)), hn::Set(f, 1e-12F));
      const VF nh = hn::Max(hn::Add(hn::Mul(ln, length), nv), zero);
      const VF inverse = hn::Div(one, hn::Mul(nn, hh));
      const VF nl = hn::Max(hn::Mul(ln, hn::Sqrt(hn::Mul(hh, inverse))), zero);
      const VF square = hn::Min(hn::Mul(hn::Mul(nh, nh), inverse), one);
      VF shine = powerOf(square, half);
      if (odd) shine = hn::Mul(shine, hn::Sqrt(square));
      VF lit = hn::Mul(diffuse, nl);
      if constexpr (!kDirectional) {
        lit = hn::Mul(lit, in.share);
        shine = hn::Mul(shine, in.share);
      }
      hn::Store(hn::Add(ambient, lit), f, p.diffuse + i);
      hn::Store(shine, f, p.shine + i);
    }
  }

  // The light's part of the colours.
  template <bool kWhite, bool kFirst>
  HWY_INLINE static void addColors(const Light& light, const Material& m, PointBatch& p) {
    const F f;
    for (int k = 0; k < 3; ++k) {
      const VF color = hn::Set(f, light.color[k]), specular = hn::Set(f, m.specular[k]);
      for (std::size_t i = 0; i < p.count; i += kLanes) {
        VF sum = hn::Add(hn::Mul(hn::Load(f, p.base[k] + i), hn::Load(f, p.diffuse + i)),
                         hn::Mul(specular, hn::Load(f, p.shine + i)));
        if constexpr (!kWhite) sum = hn::Mul(color, sum);
        if constexpr (!kFirst) sum = hn::Add(hn::Load(f, p.color[k] + i), sum);
        hn::Store(sum, f, p.color[k] + i);
      }
    }
  }

  struct Place {
    VF x, y, z;
  };

  // Where points are in view space; ScreenMap::viewDepth().
  HWY_INLINE Place placeOf(const PointBatch& p, std::size_t i) const {
    const F f;
    const VF x = hn::Load(f, p.rayX + i), y = hn::Load(f, p.rayY + i);
    const VF value = hn::Max(hn::Load(f, p.depth + i), hn::Set(f, map_.farDepth));
    if (map_.perspective) {
      const VF depth = hn::Div(hn::Set(f, 1.0F), value);
      return {hn::Mul(x, depth), hn::Mul(y, depth), hn::Neg(depth)};
    }
    const VF depth =
        hn::Mul(hn::Sub(hn::Set(f, map_.depthOffset), value), hn::Set(f, map_.farPlane - map_.nearPlane));
    return {x, y, hn::Neg(depth)};
  }

  struct Incoming {
    VF x, y, z, share;
  };

  /// incidence() of lighting.h, for lights that shine from a place.
  HWY_INLINE static Incoming incoming(const Light& light, const Place& place) {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    const VF dx = hn::Sub(hn::Set(f, light.position.x), place.x),
             dy = hn::Sub(hn::Set(f, light.position.y), place.y);
    const VF dz = hn::Sub(hn::Set(f, light.position.z), place.z);
    const VF square = hn::Max(dot3(dx, dx, dy, dy, dz, dz), hn::Set(f, 1e-30F));
    const VF inverse = hn::Div(one, hn::Sqrt(square));
    Incoming in{hn::Mul(dx, inverse), hn::Mul(dy, inverse), hn::Mul(dz, inverse), hn::Mul(inverse, inverse)};
    const auto clamped = [&](VF v) { return hn::Min(hn::Max(v, zero), one); };
    if (light.range > 0.0F) {
      const VF ratio = hn::Div(square, hn::Set(f, light.range * light.range));
      in.share = hn::Mul(in.share, clamped(hn::Sub(one, hn::Mul(ratio, ratio))));
    }
    if (light.kind == Light::Kind::kSpot) {
      const glm::vec3& s = light.direction;
      const VF cosine = hn::Neg(dot3(hn::Set(f, s.x), in.x, hn::Set(f, s.y), in.y, hn::Set(f, s.z), in.z));
      const VF inside =
          clamped(hn::Add(hn::Mul(cosine, hn::Set(f, light.spotScale)), hn::Set(f, light.spotOffset)));
      in.share = hn::Mul(in.share, hn::Mul(inside, inside));
    }
    return in;
  }

  const ScreenMap& map_;
  std::span<const Light> lights_;
  bool needsDepth_ = false;
};

/// encodeSrgb() of encode.h.
HWY_INLINE VF srgbOf(VF linear) {
  const F f;
  const VF x = hn::Min(hn::Max(linear, hn::Zero(f)), hn::Set(f, 1.0F));
  const VF u = hn::Sqrt(hn::Sqrt(x));
  VF p = hn::Set(f, kSrgbCurve[0]);
  for (int i = 1; i < 6; ++i) p = hn::Add(hn::Mul(p, u), hn::Set(f, kSrgbCurve[i]));
  return hn::IfThenElse(hn::Lt(x, hn::Set(f, kSrgbLinearEnd)), hn::Mul(x, hn::Set(f, kSrgbLinearSlope)), p);
}

/// toByte() of encode.h in the lowest byte, the bits of kRoundToInteger above it.
HWY_INLINE VI byteOf(VF value) {
  const F f;
  const VF scaled = hn::Min(hn::Max(hn::Mul(value, hn::Set(f, 255.0F)), hn::Zero(f)), hn::Set(f, 255.0F));
  return hn::BitCast(I(), hn::Add(scaled, hn::Set(f, kRoundToInteger)));
}

/// A color as the four bytes of its pixels, `alpha` being byteOf() it.
HWY_INLINE VI packedOf(const Color& c, VI alpha, Encoding encoding) {
  const bool srgb = encoding == Encoding::kSrgb;
  const VI r = byteOf(srgb ? srgbOf(c.r) : c.r), g = byteOf(srgb ? srgbOf(c.g) : c.g),
           b = byteOf(srgb ? srgbOf(c.b) : c.b);
  // Of green, blue and alpha the shifts leave nothing but the byte.
  const VI low = hn::Or(hn::And(r, hn::Set(I(), 0xff)), hn::ShiftLeft<8>(g));
  return hn::Or(low, hn::Or(hn::ShiftLeft<16>(b), hn::ShiftLeft<24>(alpha)));
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
