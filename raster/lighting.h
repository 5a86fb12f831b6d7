// The light that a point of a surface sends to the eye.
//
// Based on: J. Blinn, "Models of light reflection for computer synthesized pictures", 1977; light attenuation
// of glTF's KHR_lights_punctual. Differs in: normals come as n·q of any length, since only their direction
// counts; h is l·|v| + v for a vector v to the eye of any length, so n·h = (n·l)|v| + n·v and, as l is a unit vector,
// |h|² = 2|v|(|v| + l·v); (n·h)² / (|n|²|h|²) needs neither of them normalised, so even exponents need no square root,
// and n's length comes from the same division.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <span>

#include "raster/material.h"
#include "raster/numbers.h"
#include "raster/view.h"

namespace limn::raster {

/// x^n by repeated squaring, n >= 0.
inline float power(float x, int n) {
  float result = 1.0F;
  for (; n != 0; n >>= 1) {
    if ((n & 1) != 0) result *= x;
    x *= x;
  }
  return result;
}

/// View-space position at w = 1 (perspective) or on the window's plane (orthographic) of a sub-pixel
/// position.
inline glm::vec3 rayAt(const ScreenMap& map, std::int32_t px, std::int32_t py) {
  const auto x = static_cast<float>(px - map.width * (kSubpixels / 2));
  const auto y = static_cast<float>(map.height * (kSubpixels / 2) - py);
  return {x * map.rayX, y * map.rayY, -1.0F};
}

struct SurfacePoint {
  glm::vec3 normal;    ///< view space, any length
  glm::vec3 position;  ///< view space
  glm::vec3 toEye;     ///< any length, which is
  float eyeLength;
};

/// Sets a point's vector to the eye.
inline void setEye(const ScreenMap& map, const glm::vec3& ray, SurfacePoint& p) {
  p.toEye = map.perspective ? glm::vec3{-ray.x, -ray.y, 1.0F} : glm::vec3{0.0F, 0.0F, 1.0F};
  p.eyeLength = map.perspective ? std::sqrt((ray.x * ray.x + ray.y * ray.y) + 1.0F) : 1.0F;
}

/// Direction towards a light and how much of it arrives.
struct Incidence {
  glm::vec3 toLight;
  float share;
};

inline Incidence incidence(const Light& light, const glm::vec3& position) {
  if (light.kind == Light::Kind::kDirectional) return {light.toLight, 1.0F};
  const glm::vec3 d{light.position.x - position.x, light.position.y - position.y,
                    light.position.z - position.z};
  const float square = std::max(dot(d, d), 1e-30F), inverse = 1.0F / std::sqrt(square);
  const glm::vec3 l{d.x * inverse, d.y * inverse, d.z * inverse};
  float share = inverse * inverse;
  if (light.range > 0.0F) {
    const float ratio = square / (light.range * light.range);
    share *= std::clamp(1.0F - ratio * ratio, 0.0F, 1.0F);
  }
  if (light.kind == Light::Kind::kSpot) {
    const float cosine = -dot(light.direction, l);
    const float inside = std::clamp(cosine * light.spotScale + light.spotOffset, 0.0F, 1.0F);
    share *= inside * inside;
  }
  return {l, share};
}

/// colour = Σ light · (base · (ambient + diffuse · max(n·l, 0)) + specular · max(n·h, 0)^shininess) +
/// emissive.
inline glm::vec3 litColor(const SurfacePoint& p, const glm::vec3& base, const glm::vec3& emissive,
                          const Material& m, std::span<const Light> lights) {
  glm::vec3 color = emissive;
  const float nn = std::max(dot(p.normal, p.normal), 1e-37F), nv = dot(p.normal, p.toEye);
  for (const Light& light : lights) {
    const Incidence in = incidence(light, p.position);
    const float ln = dot(p.normal, in.toLight), lv = dot(in.toLight, p.toEye);
    const float hh = std::max((p.eyeLength + p.eyeLength) * (p.eyeLength + lv), 1e-12F);
    const float nh = std::max(ln * p.eyeLength + nv, 0.0F);
    const float inverse = 1.0F / (nn * hh);
    const float nl = std::max(ln * std::sqrt(hh * inverse), 0.0F);
    const float square = std::min((nh * nh) * inverse, 1.0F);
    float highlight = power(square, m.shininess >> 1);
    if ((m.shininess & 1) != 0) highlight *= std::sqrt(square);
    const float diffuse = light.ambient + light.diffuse * nl * in.share;
    const float shine = highlight * in.share;
    color.x += light.color.x * (base.x * diffuse + m.specular.x * shine);
    color.y += light.color.y * (base.y * diffuse + m.specular.y * shine);
    color.z += light.color.z * (base.z * diffuse + m.specular.z * shine);
  }
  return color;
}

}  // namespace limn::raster
