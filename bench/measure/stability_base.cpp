// Elementary functions against the C library's long double.
#include <array>

#include "bench/measure/extremes.h"
#include "bench/measure/stability.h"
#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

// Units in the last place of the true value, or of `least` where that is larger.
long double ulps(double value, long double truth, double least) {
  const double scale = std::max(std::abs(static_cast<double>(truth)), least);
  const double ulp = std::nextafter(scale, std::numeric_limits<double>::infinity()) - scale;
  return (value - truth) / ulp;
}

double sineError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double x = random.sign() * random.magnitude(1e-12, 1e6);
    const SinCos r = sinCos(x);
    largest.see(ulps(r.sin, std::sin(static_cast<long double>(x)), 1e-10));
    largest.see(ulps(r.cos, std::cos(static_cast<long double>(x)), 1e-10));
  }
  return largest.value();
}

double arcTangentError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double x = random.sign() * random.magnitude(1e-9, 1e9),
                 y = random.sign() * random.magnitude(1e-9, 1e9);
    const long double truth = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    largest.see(ulps(arcTangent2(y, x), truth, 1e-10));
  }
  return largest.value();
}

double arcCosineError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double x =
        random.oneIn(2) ? random.uniform(-1, 1) : random.sign() * (1.0 - random.magnitude(1e-16, 1));
    largest.see((arcCosine(x) - std::acos(static_cast<long double>(x))) * 180 / kPi);
  }
  return largest.value();
}

double exp2Error(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double x =
        random.oneIn(2) ? random.uniform(-1000, 1000) : random.sign() * random.magnitude(1e-15, 1);
    largest.see(ulps(limn::exp2(x), std::exp2(static_cast<long double>(x)), 0.0));
  }
  return largest.value();
}

double log2Error(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double x = random.oneIn(2) ? random.magnitude(1e-300, 1e300) : random.uniform(0.5, 2.0);
    largest.see(ulps(limn::log2(x), std::log2(static_cast<long double>(x)), 1e-3));
  }
  return largest.value();
}

double powerError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double x = random.magnitude(1e-10, 1e10), y = random.uniform(-3, 3);
    const long double truth = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    largest.see((power(x, y) - truth) / truth * 1e13L);
  }
  return largest.value();
}

constexpr std::array kChecks{
    KernelCheck{"sinCos", "ulp, of 1e-10 at least", 2.0, "|x| <= 1e6",
                "the reduction loses digits in proportion; NaN for infinities", sineError},
    KernelCheck{"arcTangent2", "ulp", 3.0, "magnitudes of 1e-9 to 1e9", "0 at the origin", arcTangentError},
    KernelCheck{"arcCosine", "degrees", 1e-12, "[-1, 1]", "clamped to it", arcCosineError},
    KernelCheck{"exp2", "ulp", 4.0, "[-1000, 1000]", "0 below -1022, infinity above 1023", exp2Error},
    KernelCheck{"log2", "ulp, of 0.001 at least", 4.0, "1e-300 to 1e300", "-infinity at 0, NaN below",
                log2Error},
    KernelCheck{"power", "1e-13 of the value", 1.0, "results of 1e-30 to 1e30", "0 or infinity", powerError},
};

}  // namespace

std::span<const KernelCheck> baseChecks() {
  return kChecks;
}

}  // namespace limn::measure
