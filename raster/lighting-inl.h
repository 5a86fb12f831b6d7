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

struct Color {
  VF r, g, b;
};

/// Where points are seen, rayAt() of lighting.h; their normals; and their depths where lights need them.
struct PointVector {
  VF rayX, rayY, normalX, normalY, normalZ, depth;
};

/// Up to `count` such points, their base colours, and their colours.
struct PointBatch {
  static constexpr std::size_t kSize = 256;
  alignas(64) float rayX[kSize], rayY[kSize], normal[3][kSize], depth[kSize], base[3][kSize];
  alignas(64) float color[3][kSize];
  std::size_t count = 0;

  HWY_INLINE PointVector point(std::size_t i) const {
    const F f;
    return {hn::Load(f, rayX + i),      hn::Load(f, rayY + i),      hn::Load(f, normal[0] + i),
            hn::Load(f, normal[1] + i), hn::Load(f, normal[2] + i), hn::Load(f, depth + i)};
  }
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

  /// Whether there is nothing but one directional white light, seen in perspective, and the material does not glow.
  bool isSole(const Material& m) const {
    return lights_.size() == 1 && lights_[0].kind == Light::Kind::kDirectional && isWhite(lights_[0]) &&
           map_.perspective && !isEmissive(m);
  }

  /// litColor() with the material's own emission; where isSole() holds without any question that it answers.
  template <bool kSole>
  HWY_INLINE Color litColor(const PointVector& p, const Material& m, const Color& base) const {
    const F f;
    const VF length = eyeLength(p, kSole || map_.perspective);
    if constexpr (kSole)
      return colorOf<true>(lights_[0], m, base, sharesOf<true>(lights_[0], m, p, length, true));
    // Sums begin with what need not be added.
    bool first = !isEmissive(m);
    Color color{hn::Set(f, m.emissive.x), hn::Set(f, m.emissive.y), hn::Set(f, m.emissive.z)};
    for (const Light& light : lights_) {
      const Shares shares = light.kind == Light::Kind::kDirectional
                                ? sharesOf<true>(light, m, p, length, map_.perspective)
                                : sharesOf<false>(light, m, p, length, map_.perspective);
      const Color part =
          isWhite(light) ? colorOf<true>(light, m, base, shares) : colorOf<false>(light, m, base, shares);
      color =
          first ? part : Color{hn::Add(color.r, part.r), hn::Add(color.g, part.g), hn::Add(color.b, part.b)};
      first = false;
    }
    return color;
  }

 private:
  // How much of a light the base colour and the highlight send on.
  struct Shares {
    VF diffuse, shine;
  };

  static bool isWhite(const Light& light) {
    return light.color.x == 1.0F && light.color.y == 1.0F && light.color.z == 1.0F;
  }
  static bool isEmissive(const Material& m) {
    return m.emissive.x != 0.0F || m.emissive.y != 0.0F || m.emissive.z != 0.0F;
  }

  HWY_INLINE static VF eyeLength(const PointVector& p, bool perspective) {
    const VF one = hn::Set(F(), 1.0F);
    return perspective ? hn::Sqrt(hn::Add(hn::Add(hn::Mul(p.rayX, p.rayX), hn::Mul(p.rayY, p.rayY)), one))
                       : one;
  }

  template <bool kDirectional>
  HWY_INLINE Shares sharesOf(const Light& light, const Material& m, const PointVector& p, VF length,
                             bool perspective) const {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    const VF nx = p.normalX, ny = p.normalY, nz = p.normalZ;
    // The vector to the eye is (-x, -y, 1).
    const VF x = perspective ? p.rayX : zero, y = perspective ? p.rayY : zero;
    Incoming in{hn::Set(f, light.toLight.x), hn::Set(f, light.toLight.y), hn::Set(f, light.toLight.z), one};
    if constexpr (!kDirectional) in = incoming(light, placeOf(p));
    const VF nn = hn::Max(dot3(nx, nx, ny, ny, nz, nz), hn::Set(f, 1e-37F));
    const VF nv = hn::Sub(nz, hn::Add(hn::Mul(nx, x), hn::Mul(ny, y)));
    const VF ln = dot3(nx, in.x, ny, in.y, nz, in.z);
    const VF lv = hn::Sub(in.z, hn::Add(hn::Mul(in.x, x), hn::Mul(in.y, y)));
    const VF hh = hn::Max(hn::Mul(hn::Add(length, length), hn::Add(length, lv)), hn::Set(f, 1e-12F));
    const VF nh = hn::Max(hn::Add(hn::Mul(ln, length), nv), zero);
    const VF inverse = hn::Div(one, hn::Mul(nn, hh));
    const VF nl = hn::Max(hn::Mul(ln, hn::Sqrt(hn::Mul(hh, inverse))), zero);
    const VF square = hn::Min(hn::Mul(hn::Mul(nh, nh), inverse), one);
    VF shine = powerOf(square, m.shininess >> 1), lit = hn::Mul(hn::Set(f, light.diffuse), nl);
    if ((m.shininess & 1) != 0) shine = hn::Mul(shine, hn::Sqrt(square));
    if constexpr (!kDirectional) {
      lit = hn::Mul(lit, in.share);
      shine = hn::Mul(shine, in.share);
    }
    return {hn::Add(hn::Set(f, light.ambient), lit), shine};
  }

  // The light's part of the colour.
  template <bool kWhite>
  HWY_INLINE static Color colorOf(const Light& light, const Material& m, const Color& base,
                                  const Shares& shares) {
    const F f;
    const auto channel = [&](VF value, float specular, float tint) HWY_ATTR {
      const VF sum = hn::Add(hn::Mul(value, shares.diffuse), hn::Mul(hn::Set(f, specular), shares.shine));
      return kWhite ? sum : hn::Mul(hn::Set(f, tint), sum);
    };
    return {channel(base.r, m.specular.x, light.color.x), channel(base.g, m.specular.y, light.color.y),
            channel(base.b, m.specular.z, light.color.z)};
  }

  struct Place {
    VF x, y, z;
  };

  // Where points are in view space; ScreenMap::viewDepth().
  HWY_INLINE Place placeOf(const PointVector& p) const {
    const F f;
    const VF x = p.rayX, y = p.rayY, value = hn::Max(p.depth, hn::Set(f, map_.farDepth));
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
