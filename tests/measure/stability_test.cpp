// Every bound that limn_measure stability reports is held here, with fewer cases.
#include "bench/measure/stability.h"

#include <gtest/gtest.h>

namespace limn::measure {
namespace {

constexpr std::size_t kCases = 5000;

void holdBounds(std::span<const KernelCheck> checks) {
  for (const KernelCheck& check : checks) {
    for (const std::uint64_t seed : {1u, 2u}) {
      const double largest = check.largestError(seed, kCases);
      EXPECT_LE(largest, check.bound) << check.kernel << " in " << check.unit << ", seed " << seed;
      ::testing::Test::RecordProperty(check.kernel, std::to_string(largest));
    }
  }
}

TEST(Stability, BaseKernelsKeepTheirBounds) {
  holdBounds(baseChecks());
}
TEST(Stability, SilhouetteKernelsKeepTheirBounds) {
  holdBounds(silhouetteChecks());
}
TEST(Stability, RasterKernelsKeepTheirBounds) {
  holdBounds(rasterChecks());
}

TEST(Stability, ExtremesGiveThePicturesTheyShould) {
  for (const ExtremeCheck& check : extremeChecks()) {
    EXPECT_LE(check.error(), check.bound) << check.name << ": " << check.meaning;
  }
}

}  // namespace
}  // namespace limn::measure
