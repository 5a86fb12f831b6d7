// Kernels against twins in extended or exact arithmetic, over inputs that include the
// extremes; and the whole refinement at the extremes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn::measure {

/// A kernel, its twin, and what is promised. largestError() evaluates both on `cases` inputs drawn from the domain and
/// returns the largest error in `unit`; infinity where a result is not finite.
struct KernelCheck {
  const char* kernel;
  const char* unit;
  double bound;  ///< promised in the domain
  const char* domain;
  const char* outside;  ///< what happens there
  double (*largestError)(std::uint64_t seed, std::size_t cases);
};

std::span<const KernelCheck> baseChecks();        ///< raster/base
std::span<const KernelCheck> silhouetteChecks();  ///< silhouette
std::span<const KernelCheck> rasterChecks();      ///< raster

/// A whole refinement or frame at an extreme, beside what it should be.
struct ExtremeCheck {
  const char* name;
  const char* unit;
  double bound;
  const char* meaning;  ///< of the figure
  double (*error)();
};
std::span<const ExtremeCheck> extremeChecks();

}  // namespace limn::measure
