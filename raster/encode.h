// From linear light to the bytes of the picture.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "raster/material.h"

namespace limn::raster {

inline constexpr float kSrgbCurve[6] = {-0.06275899F, 0.27275224F, -0.55755165F,
                                        1.2442140F,   0.16497400F, -0.06162971F};
inline constexpr float kSrgbLinearEnd = 0.0031308F, kSrgbLinearSlope = 12.92F;

/// The sRGB curve (IEC 61966-2-1) of a value clamped to [0, 1]: above the linear part a polynomial of degree
/// 5 in x^(1/4), fitted at its Chebyshev nodes; within 0.003 of 1/255 of the curve. Only exactly rounded
/// operations.
inline float encodeSrgb(float linear) {
  const float x = linear > 0.0F ? (linear < 1.0F ? linear : 1.0F) : 0.0F;
  const float u = std::sqrt(std::sqrt(x));
  float p = kSrgbCurve[0];
  for (int i = 1; i < 6; ++i) p = p * u + kSrgbCurve[i];
  return x < kSrgbLinearEnd ? x * kSrgbLinearSlope : p;
}

/// What rounds a small float to an integer, ties to even: in the sum the last bit counts 1.
inline constexpr float kRoundToInteger = 8388608.0F;

/// Nearest byte of a value in [0, 1]; what lies outside is clamped, NaN becomes 0.
inline std::uint8_t toByte(float value) {
  const float scaled = value * 255.0F;
  if (!(scaled > 0.0F)) return 0;
  const float sum = (scaled < 255.0F ? scaled : 255.0F) + kRoundToInteger;
  return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(sum));
}

inline std::uint8_t encode(float linear, Encoding encoding) {
  return toByte(encoding == Encoding::kSrgb ? encodeSrgb(linear) : linear);
}

}  // namespace limn::raster
