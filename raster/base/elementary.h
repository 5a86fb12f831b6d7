// Elementary functions of our own, the same to the last bit on every machine.
//
// Based on: argument reduction and Taylor series, as in any textbook on elementary functions
// (Muller, "Elementary Functions", 3rd ed., 2016, chapters 3 and 11).
// Differs in: nothing clever. Only + - * / and sqrt of IEEE double are used, in a fixed order, because the C
// library's functions differ in their last bit between libraries and, through FMA variants, between CPUs.
//
// Accuracy: within 4 ulp over the domains stated (tests/base/elementary_test.cpp holds them to it).
#pragma once

namespace limn {

inline constexpr double kPi = 3.14159265358979323846;

struct SinCos {
  double sin, cos;
};

/// Sine and cosine of `radians`, |radians| <= 1e6 (beyond that the reduction loses digits; NaN above 1e15 and for
/// non-finite).
SinCos sinCos(double radians);

/// Sine and cosine of an angle in degrees; exact at multiples of 90.
SinCos sinCosDegrees(double degrees);

double tangent(double radians);
/// Angle of the point (x, y) in (-pi, pi]; 0 for the origin.
double arcTangent2(double y, double x);
/// x clamped to [-1, 1]; result in [0, pi].
double arcCosine(double x);

/// 2^x: 0 below -1022, infinity above 1023.
double exp2(double x);
/// log2 of x > 0 (normal numbers); -infinity for 0, NaN below.
double log2(double x);
/// x^y for x >= 0; 0^0 = 1. Relative error below 1e-13 for results in [1e-30, 1e30].
double power(double x, double y);

}  // namespace limn
