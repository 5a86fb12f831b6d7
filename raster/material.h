// Materials and lights, as far as the rasterizer's shading knows them.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace limn::raster {

class Texture;  // raster/texture.h

enum class Encoding { kSrgb, kNone };  ///< of the RGBA8 result: sRGB curve, or the linear value as it is
enum class AlphaMode { kOpaque, kMask, kBlend };

/// Blinn–Phong: colour = emissive + Σ light · (base · (ambient + diffuse·max(n·l, 0)) + specular·max(n·h, 0)^shininess),
/// ambient and diffuse being the lights'. Colours are linear, factors of 1 for white, finite and >= 0; what exceeds 1 in
/// the end is clamped. The defaults are the peer scene's. Only the shininess is checked.
struct Material {
  glm::vec4 baseColor{0.85f, 0.55f, 0.30f, 1.0f};  ///< linear; times vertex colour, times texture
  glm::vec3 specular{0.4f};
  int shininess = 32;        ///< exponent, 1 … 1024
  glm::vec3 emissive{0.0f};  ///< linear
  AlphaMode alphaMode = AlphaMode::kOpaque;
  float alphaCutoff = 0.5f;  ///< kMask: where alpha, in [0, 1], is below it nothing is drawn
  bool doubleSided = false;  ///< back faces are drawn with the normal turned round
  bool unlit = false;        ///< base colour as it is
  const Texture* baseColorTexture = nullptr;
  const Texture* normalTexture = nullptr;
  float normalScale = 1.0f;  ///< of the x and y that normalTexture gives; finite
  const Texture* emissiveTexture = nullptr;
  /// KHR_texture_transform of the texture coordinates: (u, v) -> rows · (u, v, 1).
  glm::vec3 texcoordRow0{1.0f, 0.0f, 0.0f}, texcoordRow1{0.0f, 1.0f, 0.0f};
};

/// A light in view space: units are those of modelToView's results. All numbers are finite; nothing is checked.
struct Light {
  enum class Kind { kDirectional, kPoint, kSpot };
  Kind kind = Kind::kDirectional;
  glm::vec3 toLight{0.36f, 0.48f, 0.8f};  ///< kDirectional: unit vector towards the light
  glm::vec3 position{0.0f};  ///< kPoint, kSpot: falls off with the square of the distance from here
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< kSpot: unit vector it shines along
  float spotScale = 0.0f,
        spotOffset = 1.0f;  ///< kSpot: angular attenuation = clamp(cos·scale + offset, 0, 1)²
  float range = 0.0f;       ///< kPoint, kSpot: distance where nothing is left of it; 0 = unlimited
  glm::vec3 color{1.0f};    ///< linear, >= 0, intensity included: of kPoint and kSpot at distance 1
  float ambient = 0.15f;    ///< share of `color` that reaches every surface, wherever the light is
  float diffuse = 0.75f;    ///< share of `color` that a surface facing the light scatters, >= 0
};

}  // namespace limn::raster
