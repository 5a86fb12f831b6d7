// The projection and the viewport: all that the two modules must agree on about pixels.
#pragma once

namespace limn {

/// How view space (right-handed, eye at the origin looking along -z, y up) maps to the window.
///
/// With w = -z (perspective) or w = 1 (orthographic):
///   pixel x = width/2  + x/w · pixelsX        pixel y = height/2 - y/w · pixelsY   (row 0 on top)
/// Pixel (i, j) covers [i, i+1) × [j, j+1), its centre is at half integers.
struct Projection {
  bool perspective = true;
  float pixelsX = 0;  ///< pixels per unit of x at w = 1; > 0
  float pixelsY = 0;  ///< pixels per unit of y at w = 1; > 0
  float nearPlane =
      0;               ///< distance of the near plane from the eye; > 0 for perspective, any for orthographic
  float farPlane = 0;  ///< distance of the far plane; > nearPlane
  int width = 0;       ///< of the window in pixels, 1 … 16384
  int height = 0;
};

}  // namespace limn
