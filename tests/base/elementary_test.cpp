// The elementary functions against the C library in long double.
#include "raster/base/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

// Distance in units in the last place of the true value, with `floor` as the smallest scale that counts.
double ulps(double value, long double truth, double floor) {
  const double scale = std::max(std::abs(static_cast<double>(truth)), floor);
  const double ulp = std::nextafter(scale, std::numeric_limits<double>::infinity()) - scale;
  return static_cast<double>(std::abs(static_cast<long double>(value) - truth)) / ulp;
}

TEST(Elementary, SineAndCosineWithinThreeUlp) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-12, 6);
  for (int i = 0; i < 200000; ++i) {
    const double x = (i % 2 ? 1 : -1) * std::pow(10.0, exponent(random));
    const limn::SinCos r = limn::sinCos(x);
    EXPECT_LE(ulps(r.sin, std::sin(static_cast<long double>(x)), 1e-10), 3.0) << x;
    EXPECT_LE(ulps(r.cos, std::cos(static_cast<long double>(x)), 1e-10), 3.0) << x;
  }
}

TEST(Elementary, QuarterTurnsInDegreesAreExact) {
  for (int k = -40; k <= 40; ++k) {
    const limn::SinCos r = limn::sinCosDegrees(90.0 * k);
    const int sine[] = {0, 1, 0, -1};
    EXPECT_EQ(r.sin, sine[k & 3]) << k;
    EXPECT_EQ(r.cos, sine[(k + 1) & 3]) << k;
  }
}

TEST(Elementary, ArcTangentAndArcCosine) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-3, 3);
  for (int i = 0; i < 200000; ++i) {
    const double x = any(random), y = any(random);
    EXPECT_LE(ulps(limn::arcTangent2(y, x),
                   std::atan2(static_cast<long double>(y), static_cast<long double>(x)), 1e-10),
              3.0)
        << y << ' ' << x;
    const double c = x / 3;
    EXPECT_NEAR(limn::arcCosine(c), std::acos(c), 1e-14) << c;
  }
  EXPECT_EQ(limn::arcTangent2(0, 0), 0.0);
  EXPECT_EQ(limn::arcCosine(1.5), 0.0);
  EXPECT_EQ(limn::arcCosine(-1.5), limn::kPi);
}

TEST(Elementary, PowersAndLogarithms) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-30, 30), any(-1000, 1000);
  for (int i = 0; i < 200000; ++i) {
    const double x = any(random), y = exponent(random);
    EXPECT_LE(ulps(limn::exp2(x), std::exp2(static_cast<long double>(x)), 0.0), 4.0) << x;
    const double z = std::exp2(y);
    EXPECT_LE(ulps(limn::log2(z), std::log2(static_cast<long double>(z)), 1e-3), 4.0) << z;
    const double b = std::exp2(y / 3), e = x / 200;
    EXPECT_NEAR(limn::power(b, e) / std::pow(b, e), 1.0, 1e-13) << b << ' ' << e;
  }
  EXPECT_EQ(limn::exp2(-2000), 0.0);
  EXPECT_EQ(limn::exp2(10), 1024.0);
  EXPECT_EQ(limn::log2(1024), 10.0);
  EXPECT_EQ(limn::power(0, 0), 1.0);
  EXPECT_EQ(limn::power(0, 2), 0.0);
}

}  // namespace
