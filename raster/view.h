// From view space to the sub-pixel grid: the one place where coordinates are rounded.
//
// Based on: M. Abrash, "Rasterization on Larrabee", 2009 (fixed-point snapping, exact edge functions);
// Direct3D 11 functional specification, 2015, section 3.4 (8 sub-pixel bits, top-left rule). Differs in:
// depth is 1/w itself (orthographic: 1 at the near plane, 0 at the far one), larger is nearer. As a float its
// relative precision is the same from near to far, so near : far = 1 : 1e7 is no harder than 1 : 10.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "raster/base/projection.h"
#include "raster/numbers.h"
#include "raster/samples.h"

namespace limn::raster {

/// How far beyond the window coordinates may go before they are clipped geometrically. With it no difference
/// of two coordinates exceeds 2^23, exact in a float, and edge functions fit 32 bits within a tile (see
/// triangle.h).
inline constexpr int kGuardPixels = 8191;

/// v -> (rows · (v, 1)), evaluated as ((m0·x + m1·y) + m2·z) + m3 everywhere.
struct Affine {
  float m[3][4];

  Affine() = default;
  explicit Affine(const glm::mat4& matrix) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) m[i][j] = matrix[j][i];
  }
  glm::vec3 operator()(float x, float y, float z) const {
    return {row(0, x, y, z), row(1, x, y, z), row(2, x, y, z)};
  }
  float row(int i, float x, float y, float z) const {
    return ((m[i][0] * x + m[i][1] * y) + m[i][2] * z) + m[i][3];
  }
};

/// A vertex on the sub-pixel grid. `q` weights attributes for perspective-correct interpolation: 1/w, or 1.
struct ScreenVertex {
  std::int32_t x, y;
  float depth, q;
};

/// The projection as the vertex kernels use it.
struct ScreenMap {
  explicit ScreenMap(const Projection& p)
      : perspective(p.perspective),
        scaleX(p.pixelsX * kSubpixels),
        scaleY(-p.pixelsY * kSubpixels),
        offsetX(static_cast<float>(p.width) * (kSubpixels / 2) + 0.5F),
        offsetY(static_cast<float>(p.height) * (kSubpixels / 2) + 0.5F),
        depthScale(1.0F / (p.farPlane - p.nearPlane)),
        depthOffset(p.farPlane / (p.farPlane - p.nearPlane)),
        farDepth(p.perspective ? 1.0F / p.farPlane : 0.0F),
        nearPlane(p.nearPlane),
        farPlane(p.farPlane),
        rayX(1.0F / (p.pixelsX * kSubpixels)),
        rayY(1.0F / (p.pixelsY * kSubpixels)),
        width(p.width),
        height(p.height) {}

  ScreenVertex project(const glm::vec3& view) const {
    const float q = perspective ? 1.0F / -view.z : 1.0F;
    const float x = std::floor((view.x * q) * scaleX + offsetX);
    const float y = std::floor((view.y * q) * scaleY + offsetY);
    const float depth = perspective ? q : view.z * depthScale + depthOffset;
    return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), depth, q};
  }

  /// Distance along -z of a depth value, at most that of the far plane.
  float viewDepth(float depth) const {
    const float within = larger(depth, farDepth);
    return perspective ? 1.0F / within : (depthOffset - within) * (farPlane - nearPlane);
  }

  bool perspective;
  float scaleX, scaleY;           ///< sub-pixels per unit at w = 1; y points down
  float offsetX, offsetY;         ///< window centre plus the half of rounding to nearest by floor
  float depthScale, depthOffset;  ///< orthographic depth = z · scale + offset
  float farDepth;                 ///< depth of the far plane
  float nearPlane, farPlane;
  float rayX, rayY;  ///< view-space x at w = 1 per sub-pixel from the window's centre
  int width, height;
};

}  // namespace limn::raster
