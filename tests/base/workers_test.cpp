// Every index exactly once, and a scratch slot of one's own, for any number of threads.
#include "raster/base/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace {

TEST(Workers, EveryIndexOnceAndSlotsAreExclusive) {
  for (int threads : {1, 2, 3, 8, 32}) {
    limn::Workers workers(threads);
    for (std::size_t count : {0UL, 1UL, 7UL, 64UL, 1000UL, 4097UL}) {
      std::vector<std::atomic<int>> seen(count);
      std::vector<std::atomic<int>> inside(static_cast<std::size_t>(threads));
      workers.forBlocks(count, 64, [&](std::size_t begin, std::size_t end, int slot) {
        ASSERT_LT(slot, threads);
        EXPECT_EQ(begin % 64, 0U);
        EXPECT_LE(end - begin, 64U);
        EXPECT_EQ(inside[static_cast<std::size_t>(slot)].fetch_add(1), 0);
        for (std::size_t i = begin; i < end; ++i) seen[i].fetch_add(1);
        inside[static_cast<std::size_t>(slot)].fetch_sub(1);
      });
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(seen[i].load(), 1) << i;
    }
  }
}

TEST(Workers, RefusesNoThreadsAndTooMany) {
  EXPECT_THROW(limn::Workers(0), std::invalid_argument);
  EXPECT_THROW(limn::Workers(1025), std::invalid_argument);
}

TEST(Workers, TakesAsManyAsThereAre) {
  const limn::Workers workers(limn::availableThreads());
  EXPECT_EQ(workers.threads(), limn::availableThreads());
}

}  // namespace
