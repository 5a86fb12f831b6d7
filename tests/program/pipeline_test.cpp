// Every picture is finished once, in bounded memory, and a failure reaches the caller.
#include "apps/limn/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "raster/base/workers.h"

namespace {

using limn::program::InOrder;
using limn::program::Picture;
using limn::program::Pipeline;

TEST(Pipeline, FinishesEveryPictureOnceWithFewInFlight) {
  for (const int threads : {1, 2, 3, 8}) {
    const limn::Workers workers(threads);  // lets the library have so many threads
    constexpr int kCount = 200;
    std::vector<std::atomic<int>> finished(kCount);
    std::atomic<int> inside{0}, most{0};
    {
      Pipeline pipeline(threads, 1000, [&](Picture& picture) {
        const int now = ++inside;
        int seen = most;
        while (now > seen && !most.compare_exchange_weak(seen, now)) {
        }
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        ++finished[static_cast<std::size_t>(picture.position)];
        --inside;
      });
      for (int i = 0; i < kCount; ++i) {
        auto picture = pipeline.acquire();
        picture->position = i;
        pipeline.submit(std::move(picture));
      }
      pipeline.drain();
    }
    for (const auto& count : finished) ASSERT_EQ(count, 1);
    EXPECT_LE(most, threads);
  }
}

TEST(Pipeline, KeepsStandardOutputInOrder) {
  for (const int threads : {1, 2, 5}) {
    const limn::Workers workers(threads);
    InOrder inOrder;
    std::vector<int> order;
    {
      Pipeline pipeline(threads, 1000, [&](Picture& picture) {
        std::this_thread::sleep_for(std::chrono::microseconds(picture.position % 3 * 200));
        inOrder.run(picture.position, [&] { order.push_back(picture.position); });
      });
      for (int i = 0; i < 60; ++i) {
        auto picture = pipeline.acquire();
        picture->position = i;
        pipeline.submit(std::move(picture));
      }
      pipeline.drain();
    }
    EXPECT_EQ(order.size(), 60U);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  }
}

TEST(Pipeline, AFailureIsRethrownAndTheRestLeftOut) {
  for (const int threads : {1, 2, 4}) {
    const limn::Workers workers(threads);
    InOrder inOrder;
    std::atomic<int> finished{0};
    const auto run = [&] {
      Pipeline pipeline(threads, 1000, [&](Picture& picture) {
        try {
          inOrder.run(picture.position, [&] {
            if (picture.position == 5) throw std::runtime_error("full");
            ++finished;
          });
        } catch (...) {
          inOrder.abandon();
          throw;
        }
      });
      for (int i = 0; i < 1000; ++i) {
        auto picture = pipeline.acquire();
        picture->position = i;
        pipeline.submit(std::move(picture));
      }
      pipeline.drain();
    };
    EXPECT_THROW(run(), std::runtime_error);
    EXPECT_EQ(finished, 5);
    finished = 0;
  }
}

TEST(InOrder, APictureThatFailsBeforeItsTurnHoldsUpNobody) {
  InOrder inOrder;
  std::atomic<int> written{0};
  const auto write = [&] { ++written; };
  inOrder.run(0, write);
  std::thread second([&] { inOrder.run(2, write); });  // waits for position 1, which never comes
  inOrder.abandon();
  second.join();
  inOrder.run(3, write);
  EXPECT_EQ(written, 1);
}

}  // namespace
