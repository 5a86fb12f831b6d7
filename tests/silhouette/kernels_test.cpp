// Vector kernels against their scalar twins, bit for bit on every target.
#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "shapes.h"
#include "silhouette/alpha_kernel.h"
#include "silhouette/chord_kernel.h"
#include "silhouette/contour.h"
#include "silhouette/crossing_kernel.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

struct Random {
  std::mt19937 engine;
  float next() { return static_cast<float>(engine() % 2000001) / 1000000.0f - 1.0f; }
  vec3 vector() { return {next(), next(), next()}; }
};

template <class Body>
void onEveryTarget(const Body& body) {
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    SCOPED_TRACE(hwy::TargetName(targets & -targets));
    hwy::SetSupportedTargetsForTest(targets & -targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body();
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

std::uint32_t bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

TEST(AlphaKernel, EveryTargetGivesTheScalarBits) {
  Random random{std::mt19937(3)};
  for (int round = 0; round < 40; ++round) {
    // More than fit into registers, as many as do, and fewer; room for whole vectors.
    constexpr std::array<std::size_t, 4> kCounts = {90, 64, 41, 7};
    const std::size_t count = kCounts[static_cast<std::size_t>(round) % kCounts.size()];
    std::vector<float> facings;
    // Wide, narrow, one-sided, with zeros and ties, and tiny.
    for (int i = 0; i < 96; ++i) {
      const float x = random.next();
      facings.push_back(round % 5 == 0   ? x
                        : round % 5 == 1 ? 0.3f + 0.1f * x
                        : round % 5 == 2 ? -0.02f * (1.1f + x)
                        : round % 5 == 3 ? static_cast<float>(static_cast<int>(4.0f * x)) / 4.0f
                                         : 1e-38f * x);
    }
    std::vector<std::uint16_t> corners(6 * kEdgesPerCluster);
    for (std::uint16_t& corner : corners) corner = static_cast<std::uint16_t>(random.engine() % count);
    std::array<float, kEdgesPerCluster> betas{}, bulges{}, expected{}, alphas{};
    for (std::size_t i = 0; i < kEdgesPerCluster; ++i) {
      betas[i] = i % 7 == 0 ? 0.0f : std::fabs(random.next());
      bulges[i] = i % 9 == 0 ? 0.0f : std::fabs(random.next());
    }
    const EdgeBlock block{corners.data(), facings.data(), count, betas.data(), bulges.data()};
    for (const bool crossing : {false, true}) {
      const std::uint64_t bends = computeAlphasScalar(block, crossing, 0.1f, expected.data());
      onEveryTarget([&] {
        EXPECT_EQ(computeAlphas(block, crossing, 0.1f, alphas.data()), bends);
        for (std::size_t i = 0; i < kEdgesPerCluster; ++i) {
          ASSERT_EQ(bits(alphas[i]), bits(expected[i])) << "round " << round << ", edge " << i;
          ASSERT_TRUE(alphas[i] >= 0.0f && alphas[i] <= 1.0f);
        }
      });
    }
  }
}

TEST(ChordKernel, EveryTargetGivesTheScalarBits) {
  Random random{std::mt19937(4)};
  for (const View& view : someViews(2.0f)) {
    const PixelBound bound(view);
    for (const std::size_t count : {std::size_t{1}, std::size_t{17}, CurveBatch::kCapacity}) {
      CurveBatch batch{};
      std::vector<CurveError> expected;
      while (batch.count < count) {
        const vec3 p = 2.0f * random.vector(), q = 2.0f * random.vector();
        const CurveOffsets d{random.vector(), random.vector()};
        batch.add(p, q, d[0], d[1]);
        expected.push_back(bound.curveError(p, q, d));
      }
      onEveryTarget([&] {
        CurveErrors errors;
        curveErrors(bound, batch, errors);
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_EQ(bits(errors.bends[i]), bits(expected[i].bend)) << i;
          ASSERT_EQ(bits(errors.chords[i]), bits(expected[i].chord)) << i;
        }
      });
    }
  }
}

// Edges that the contour crosses: near an end, in the middle, edge on, with normals that cancel and that are zero, with
// numbers of every size and what are none.
TEST(CrossingKernel, EveryTargetGivesTheScalarBits) {
  constexpr std::array<float, 8> sizes{1.0f,   1.0f,   1.0f,  1.0f,
                                       1e-38f, 1e-44f, 1e38f, std::numeric_limits<float>::infinity()};
  // What is no number may be so in several ways.
  const auto same = [](float a, float b) { return bits(a) == bits(b) || (std::isnan(a) && std::isnan(b)); };
  Random random{std::mt19937(5)};
  for (const View& view : someViews(2.0f)) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{17}, CrossedBatch::kCapacity}) {
      CrossedBatch batch{};
      while (batch.count < count) {
        const std::size_t kind = random.engine() % 8;
        const vec3 p = 2.0f * random.vector(),
                   q = kind == 1 ? p + 1e-6f * random.vector() : 2.0f * random.vector();
        const float size = sizes[kind];
        const vec3 n = size * (kind == 3 ? vec3(0.0f) : random.vector()),
                   m = kind == 2 ? -n : size * random.vector();
        if ((facing(view, p, n) >= 0.0f) == (facing(view, q, m) >= 0.0f)) continue;
        batch.add(p, q, n, m, size * random.vector(), size * random.vector());
      }
      Crossings expected{}, crossings{};
      computeCrossingsScalar(view, batch, expected);
      onEveryTarget([&] {
        computeCrossings(view, batch, crossings);
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_TRUE(expected.parameters[i] >= 0.0f && expected.parameters[i] <= 1.0f) << i;
          ASSERT_EQ(bits(crossings.parameters[i]), bits(expected.parameters[i])) << i;
          ASSERT_TRUE(same(crossings.squares[i], expected.squares[i])) << i;
          for (std::size_t k = 0; k < 9; ++k)
            ASSERT_TRUE(same(crossings.vectors.coordinates[k][i], expected.vectors.coordinates[k][i]))
                << "coordinate " << k << " of " << i;
        }
      });
    }
  }
}

}  // namespace
}  // namespace limn::silhouette::test
