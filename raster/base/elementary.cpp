#include "raster/base/elementary.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace limn {
namespace {

// Horner's rule for sum c[k] x^k.
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) {
  double sum = c[N - 1];
  for (std::size_t k = N - 1; k-- > 0;) sum = sum * x + c[k];
  return sum;
}

// Taylor coefficients in x²; the first omitted terms are below 1e-19 on [0, pi/4].
constexpr std::array<double, 8> kSine = {
    -1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,          1.0 / 362880.0,
    -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
constexpr std::array<double, 8> kCosine = {
    1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,          -1.0 / 3628800.0,
    1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0, -1.0 / 6402373705728000.0};

// On |x| <= pi/4, with the low part of the reduced argument.
SinCos sinCosReduced(double x, double low) {
  const double z = x * x;
  const double sine = x + (x * z * polynomial(kSine, z) + low);
  const double cosine = 1.0 - (0.5 * z - (z * z * polynomial(kCosine, z) - x * low));
  return {sine, cosine};
}

// (sin, cos) of quadrant * pi/2 + the reduced angle.
SinCos turned(SinCos r, std::int64_t quadrant) {
  switch (quadrant & 3) {
    case 0:
      return r;
    case 1:
      return {r.cos, -r.sin};
    case 2:
      return {-r.sin, -r.cos};
    default:
      return {-r.cos, r.sin};
  }
}

// atan(k/8), k = 0…8.
constexpr std::array<double, 9> kArcTangent = {
    0.0,
    0.12435499454676144,
    0.24497866312686414,
    0.35877067027057225,
    0.4636476090008061,
    0.5585993153435624,
    0.6435011087932844,
    0.7188299996216245,
    0.7853981633974483,
};

// On [0, 1]: atan x = atan c + atan((x - c)/(1 + x c)) with c the nearest eighth.
double arcTangentUnit(double x) {
  const int k = static_cast<int>(x * 8.0 + 0.5);
  const double c = k / 8.0;
  const double t = (x - c) / (1.0 + x * c);
  const double z = t * t;
  constexpr std::array<double, 8> kSeries = {-1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0,  1.0 / 9.0,
                                             -1.0 / 11.0, 1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0};
  return kArcTangent[static_cast<std::size_t>(k)] + (t + t * z * polynomial(kSeries, z));
}

constexpr double kLn2 = 0.69314718055994530942;

}  // namespace

SinCos sinCos(double radians) {
  if (!(std::abs(radians) <= 1e15)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  // pi/2 in three parts; the products with a quadrant below 2^20 are exact in the first two (33 bits each).
  constexpr double kHalfPi1 = 1.57079632673412561417e+00;
  constexpr double kHalfPi2 = 6.07710050630396597660e-11;
  constexpr double kHalfPi3 = 2.02226624879595063154e-21;
  const double quadrant = std::floor(radians * (2.0 / kPi) + 0.5);
  const double high1 = radians - quadrant * kHalfPi1, part2 = quadrant * kHalfPi2;
  const double high2 = high1 - part2;
  // What the subtraction rounded off: Knuth's TwoSum, since near multiples of pi/2 either operand may be the larger.
  const double shift = high2 - high1;
  const double low2 = ((high1 - (high2 - shift)) - (part2 + shift)) - quadrant * kHalfPi3;
  // At large angles the third part is not small against an ulp: carry it over.
  const double high = high2 + low2, low = low2 - (high - high2);
  return turned(sinCosReduced(high, low), static_cast<std::int64_t>(quadrant));
}

SinCos sinCosDegrees(double degrees) {
  const double quadrant = std::floor(degrees / 90.0 + 0.5);
  const double rest = degrees - quadrant * 90.0;  // exact
  return turned(sinCosReduced(rest * (kPi / 180.0), 0.0), static_cast<std::int64_t>(quadrant));
}

double tangent(double radians) {
  const SinCos r = sinCos(radians);
  return r.sin / r.cos;
}

double arcTangent2(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  if (ax == 0.0 && ay == 0.0) return 0.0;
  const double acute = ay <= ax ? arcTangentUnit(ay / ax) : kPi / 2 - arcTangentUnit(ax / ay);
  const double upper = x < 0.0 ? kPi - acute : acute;
  return y < 0.0 ? -upper : upper;
}

double arcCosine(double x) {
  if (x >= 1.0) return 0.0;
  if (x <= -1.0) return kPi;
  return arcTangent2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

double exp2(double x) {
  if (x != x) return x;
  if (x > 1023.0) return std::numeric_limits<double>::infinity();
  if (x < -1022.0) return 0.0;
  const double whole = std::floor(x + 0.5);
  const double y = (x - whole) * kLn2;  // |y| <= 0.347
  constexpr std::array<double, 15> kSeries = {1.0,
                                              1.0,
                                              1.0 / 2.0,
                                              1.0 / 6.0,
                                              1.0 / 24.0,
                                              1.0 / 120.0,
                                              1.0 / 720.0,
                                              1.0 / 5040.0,
                                              1.0 / 40320.0,
                                              1.0 / 362880.0,
                                              1.0 / 3628800.0,
                                              1.0 / 39916800.0,
                                              1.0 / 479001600.0,
                                              1.0 / 6227020800.0,
                                              1.0 / 87178291200.0};
  const double scale =
      std::bit_cast<double>(static_cast<std::uint64_t>(static_cast<std::int64_t>(whole) + 1023) << 52);
  return polynomial(kSeries, y) * scale;
}

double log2(double x) {
  if (x != x || x < 0.0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0) return -std::numeric_limits<double>::infinity();
  if (x == std::numeric_limits<double>::infinity()) return x;
  if (x < std::numeric_limits<double>::min()) return log2(x * 0x1p54) - 54.0;
  std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  std::int64_t exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  bits = (bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL;
  double m = std::bit_cast<double>(bits);  // in [1, 2), then [0.707, 1.414)
  if (m > 1.41421356237309504880) {
    m *= 0.5;
    ++exponent;
  }
  // ln m = 2 artanh s, s = (m-1)/(m+1), |s| <= 0.172
  const double s = (m - 1.0) / (m + 1.0);
  constexpr std::array<double, 12> kSeries = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,
                                              1.0 / 9.0,  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0,
                                              1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0};
  const double logarithm = 2.0 * s * polynomial(kSeries, s * s);
  return static_cast<double>(exponent) + logarithm * (1.0 / kLn2);
}

double power(double x, double y) {
  if (y == 0.0) return 1.0;
  if (x == 0.0) return y > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
  return exp2(y * log2(x));
}

}  // namespace limn
