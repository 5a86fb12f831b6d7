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

/// Points to be shaded: where in the window, with which normals and depth.
struct Points {
  VI px, py;
  VF nx, ny, nz, depth;
};

struct Color {
  VF r, g, b;
};

/// power() of lighting.h.
HWY_INLINE VF powerOf(VF x, int n) {
  VF result = hn::Set(F(), 1.0F);
  for (; n != 0; n >>= 1) {
    if ((n & 1) != 0) result = hn::Mul(result, x);
    x = hn::Mul(x, x);
  }
  return result;
}

class Lighting {
 public:
  Lighting(const ScreenMap& map, std::span<const Light> lights) : map_(map), lights_(lights) {
    for (const Light& light : lights) needsDepth_ |= light.kind != Light::Kind::kDirectional;
  }

  /// Some light shines from a place: points need their depths.
  bool needsDepth() const { return needsDepth_; }

  /// litColor() with the material's own emission.
  HWY_INLINE Color operator()(const Points& p, const Color& base, const Material& m) const {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    const Eye eye = eyeOf(p);
    const VF nn = hn::Max(dot3(p.nx, p.nx, p.ny, p.ny, p.nz, p.nz), hn::Set(f, 1e-37F));
    const VF inverse = hn::Div(one, hn::Sqrt(nn));
    // Sums begin with what need not be added.
    const bool dark = m.emissive.x == 0.0F && m.emissive.y == 0.0F && m.emissive.z == 0.0F;
    Color color{hn::Set(f, m.emissive.x), hn::Set(f, m.emissive.y), hn::Set(f, m.emissive.z)};
    bool first = dark;
    for (const Light& light : lights_) {
      const Incoming in = incoming(light, eye);
      const VF hx = hn::Add(hn::Mul(in.x, eye.length), eye.x), hy = hn::Add(hn::Mul(in.y, eye.length), eye.y);
      const VF hz = hn::Add(hn::Mul(in.z, eye.length), eye.z);
      const VF nl = hn::Max(hn::Mul(dot3(p.nx, in.x, p.ny, in.y, p.nz, in.z), inverse), zero);
      const VF nh = hn::Max(dot3(p.nx, hx, p.ny, hy, p.nz, hz), zero);
      const VF hh = hn::Max(dot3(hx, hx, hy, hy, hz, hz), hn::Set(f, 1e-12F));
      const VF square = hn::Div(hn::Mul(nh, nh), hn::Mul(nn, hh));
      VF shine = powerOf(square, m.shininess >> 1);
      if ((m.shininess & 1) != 0) shine = hn::Mul(shine, hn::Sqrt(square));
      VF diffuse = hn::Mul(hn::Set(f, light.diffuse), nl);
      if (light.kind != Light::Kind::kDirectional) {
        diffuse = hn::Mul(diffuse, in.share);
        shine = hn::Mul(shine, in.share);
      }
      diffuse = hn::Add(hn::Set(f, light.ambient), diffuse);
      const bool white = light.color.x == 1.0F && light.color.y == 1.0F && light.color.z == 1.0F;
      const auto add = [&](VF& to, float lightColor, VF baseColor, float specular) {
        VF sum = hn::Add(hn::Mul(baseColor, diffuse), hn::Mul(hn::Set(f, specular), shine));
        if (!white) sum = hn::Mul(hn::Set(f, lightColor), sum);
        to = first ? sum : hn::Add(to, sum);
      };
      add(color.r, light.color.x, base.r, m.specular.x);
      add(color.g, light.color.y, base.g, m.specular.y);
      add(color.b, light.color.z, base.b, m.specular.z);
      first = false;
    }
    return color;
  }

 private:
  // A vector to the eye and its length, and where the point is.
  struct Eye {
    VF x, y, z, length;
    VF px, py, pz;
  };

  HWY_INLINE Eye eyeOf(const Points& p) const {
    const I d;
    const F f;
    Eye eye;
    const VF one = hn::Set(f, 1.0F);
    const VI cx = hn::Set(d, map_.width * (kSubpixels / 2)), cy = hn::Set(d, map_.height * (kSubpixels / 2));
    const VF x = hn::Mul(hn::ConvertTo(f, hn::Sub(p.px, cx)), hn::Set(f, map_.rayX));
    const VF y = hn::Mul(hn::ConvertTo(f, hn::Sub(cy, p.py)), hn::Set(f, map_.rayY));
    eye.x = map_.perspective ? hn::Neg(x) : hn::Zero(f);
    eye.y = map_.perspective ? hn::Neg(y) : hn::Zero(f);
    eye.z = one;
    eye.length = map_.perspective ? hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), one)) : one;
    eye.px = x, eye.py = y, eye.pz = one;
    if (!needsDepth_) return eye;
    if (map_.perspective) {
      const VF depth = hn::Div(one, p.depth);
      eye.px = hn::Mul(x, depth), eye.py = hn::Mul(y, depth), eye.pz = hn::Neg(depth);
    } else {
      const VF depth =
          hn::Mul(hn::Sub(hn::Set(f, map_.depthOffset), p.depth), hn::Set(f, map_.farPlane - map_.nearPlane));
      eye.pz = hn::Neg(depth);
    }
    return eye;
  }

  struct Incoming {
    VF x, y, z, share;
  };

  /// incidence() of lighting.h.
  HWY_INLINE static Incoming incoming(const Light& light, const Eye& eye) {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    if (light.kind == Light::Kind::kDirectional)
      return {hn::Set(f, light.toLight.x), hn::Set(f, light.toLight.y), hn::Set(f, light.toLight.z), one};
    const VF dx = hn::Sub(hn::Set(f, light.position.x), eye.px),
             dy = hn::Sub(hn::Set(f, light.position.y), eye.py);
    const VF dz = hn::Sub(hn::Set(f, light.position.z), eye.pz);
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

/// toByte() of encode.h.
HWY_INLINE VI byteOf(VF value) {
  const F f;
  const VF scaled = hn::Add(hn::Mul(value, hn::Set(f, 255.0F)), hn::Set(f, 0.5F));
  return hn::ConvertTo(I(), hn::Min(hn::Max(scaled, hn::Zero(f)), hn::Set(f, 255.0F)));
}

/// A color as the four bytes of its pixels.
HWY_INLINE VI packedOf(const Color& c, VI alpha, Encoding encoding) {
  const bool srgb = encoding == Encoding::kSrgb;
  const VI r = byteOf(srgb ? srgbOf(c.r) : c.r), g = byteOf(srgb ? srgbOf(c.g) : c.g),
           b = byteOf(srgb ? srgbOf(c.b) : c.b);
  return hn::Or(hn::Or(r, hn::ShiftLeft<8>(g)), hn::Or(hn::ShiftLeft<16>(b), hn::ShiftLeft<24>(alpha)));
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
