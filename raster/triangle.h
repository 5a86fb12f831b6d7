// One triangle on the sub-pixel grid: its edge functions and its interpolation planes.
//
// Based on: J. Pineda, "A parallel algorithm for polygon rasterization", 1988 (edge functions); Direct3D 11
// functional specification, section 3.4.2.1 (top-left rule). Differs in: edge functions are kept divided by
// 256, rounded down. Samples lie on the sub-pixel grid and pixels are 256 sub-pixels apart, so at any one
// sample position E changes by multiples of 256 from pixel to pixel, and E >= 0 exactly where floor(E/256) >=
// 0. That fits 32 bits within a tile for every triangle of the guard band.
#pragma once

#include <cmath>
#include <cstdint>

#include "raster/view.h"

namespace limn::raster {

/// Corners of a triangle; drawn ones are in the order that makes the area positive.
struct Corners {
  std::int32_t x[3], y[3];
};

/// Twice the signed area; positive if the corners run clockwise as seen on screen.
inline std::int64_t signedArea(const Corners& c) {
  return static_cast<std::int64_t>(c.x[1] - c.x[0]) * (c.y[2] - c.y[0]) -
         static_cast<std::int64_t>(c.x[2] - c.x[0]) * (c.y[1] - c.y[0]);
}

/// Of a triangle's signed area: with y pointing down what is counter-clockwise in view space has a negative one.
inline bool facesAway(std::int64_t area, bool mirrored) {
  return mirrored ? area < 0 : area > 0;
}

/// E(x, y) of the edge from (ax, ay) to (bx, by): >= 0 inside, the top-left rule included as a bias of -1.
struct Edge {
  std::int32_t ax, ay, dx, dy, bias;

  static Edge of(const Corners& c, int from, int to) {
    const std::int32_t dx = c.x[to] - c.x[from], dy = c.y[to] - c.y[from];
    const bool topLeft = dy < 0 || (dy == 0 && dx > 0);
    return {c.x[from], c.y[from], dx, dy, topLeft ? 0 : -1};
  }
  std::int64_t at(std::int32_t x, std::int32_t y) const {
    return static_cast<std::int64_t>(dx) * (y - ay) - static_cast<std::int64_t>(dy) * (x - ax) + bias;
  }
};

inline bool covers(const Corners& c, std::int32_t x, std::int32_t y) {
  return Edge::of(c, 0, 1).at(x, y) >= 0 && Edge::of(c, 1, 2).at(x, y) >= 0 &&
         Edge::of(c, 2, 0).at(x, y) >= 0;
}

/// Of a value's plane, per sub-pixel (see Record::value).
struct Slopes {
  float x, y;
};

/// How the planes of a triangle follow from the values at its corners: one per triangle, for all values.
struct PlaneBasis {
  // slopeX = (v1 - v0) · x1 - (v2 - v0) · x2, slopeY = (v2 - v0) · y2 - (v1 - v0) · y1
  float x1, x2, y1, y2;

  explicit PlaneBasis(const Corners& c) {
    const auto area = static_cast<float>(signedArea(c));
    if (setSliver(c, area)) return;
    const float inverse = 1.0F / area;
    x1 = static_cast<float>(c.y[2] - c.y[0]) * inverse;
    x2 = static_cast<float>(c.y[1] - c.y[0]) * inverse;
    y1 = static_cast<float>(c.x[2] - c.x[0]) * inverse;
    y2 = static_cast<float>(c.x[1] - c.x[0]) * inverse;
  }
  Slopes slopes(float v0, float v1, float v2) const {
    const float d1 = v1 - v0, d2 = v2 - v0;
    return {d1 * x1 - d2 * x2, d2 * y2 - d1 * y1};
  }

 private:
  // A triangle lower than half a pixel and over 4096 times longer: slopes across it are rounding noise that
  // would be magnified along it. Values then vary along the longer edge at the anchor only.
  static constexpr float kSliverAspect = 4096.0F, kSliverHeight = 128.0F;

  bool setSliver(const Corners& c, float area) {
    const auto ex = static_cast<float>(c.x[1] - c.x[0]), ey = static_cast<float>(c.y[1] - c.y[0]);
    const auto fx = static_cast<float>(c.x[2] - c.x[0]), fy = static_cast<float>(c.y[2] - c.y[0]);
    const float e = ex * ex + ey * ey, f = fx * fx + fy * fy, longest = e > f ? e : f;
    if (area * kSliverAspect > longest || area * area > kSliverHeight * kSliverHeight * longest) return false;
    x1 = e > f ? ex / e : 0.0F, y1 = e > f ? -ey / e : 0.0F;
    x2 = e > f ? 0.0F : -fx / f, y2 = e > f ? 0.0F : fy / f;
    return true;
  }
};

}  // namespace limn::raster
