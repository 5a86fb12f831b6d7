// Silhouetteness of many edges at a time, from the facings of their corners.
#pragma once

#include <cstddef>
#include <cstdint>

namespace limn::silhouette {

inline constexpr std::size_t kEdgesPerCluster = 64;

/// 64 edges, structure of arrays.
struct EdgeBlock {
  /// corners[k · 64 + i] of edge i: indices into `facings`. k = 0, 1 its ends and 2 the opposite corner in the first
  /// face, 3, 4 and 5 likewise in the second.
  const std::uint16_t* corners;
  const float* facings;
  std::size_t facingCount;  ///< of facings; room for whole vectors of 16
  const float* betas;
  const float* bulges;  ///< the most that curve or patches rise above the edge at α = 1, in model units
};

/// α of the 64 edges by crossingSilhouetteness or contourSilhouetteness; returns bit i set where α > 0 and
/// α · bulge > threshold. The vector units of the machine do it; the same bits as computeAlphasScalar on all of them.
std::uint64_t computeAlphas(const EdgeBlock& edges, bool crossing, float threshold, float* alphas);

/// The definition of correct.
std::uint64_t computeAlphasScalar(const EdgeBlock& edges, bool crossing, float threshold, float* alphas);

}  // namespace limn::silhouette
