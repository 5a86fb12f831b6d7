// limn_bench_limits: what this machine could do at best, and the lower bound that gives for a frame of the grid scene:
// 1280×800 pixels of RGBA8 and depth cleared, half of them tested, lit with 110 operations each, and written.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "bench/frames/timing.h"
#include "bench/limits/peak.h"

namespace limn::bench {
namespace {

constexpr double kPixels = 1280.0 * 800.0;
constexpr std::size_t kFrameBytes = std::size_t{1280} * 800 * 4;
constexpr double kOperationsPerPixel = 110.0;

/// The shortest time that `threads` took to do work(thread) together, in `repeats` attempts that start at once.
template <class Work>
double bestSeconds(std::size_t threads, std::size_t repeats, const Work& work) {
  std::atomic<std::size_t> arrived{0};
  std::vector<double> starts(threads * repeats), ends(starts.size());
  const auto body = [&](std::size_t thread) {
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
      arrived.fetch_add(1);
      while (arrived.load() < threads * (repeat + 1)) std::this_thread::yield();
      starts[repeat * threads + thread] = wallSeconds();
      work(thread);
      ends[repeat * threads + thread] = wallSeconds();
    }
  };
  std::vector<std::thread> others;
  for (std::size_t thread = 1; thread < threads; ++thread) others.emplace_back(body, thread);
  body(0);
  for (std::thread& other : others) other.join();
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first < starts.size(); first += threads) {
    const auto begin = starts.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = ends.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = static_cast<std::ptrdiff_t>(threads);
    best = std::min(best, *std::max_element(end, end + count) - *std::min_element(begin, begin + count));
  }
  return best;
}

struct Rates {
  double bytes, operations;  ///< per second
};

Rates measure(std::size_t threads) {
  std::vector<std::uint8_t> frame(kFrameBytes);
  const std::size_t part = kFrameBytes / threads;
  const double fill = bestSeconds(threads, 400, [&](std::size_t thread) {
    std::memset(frame.data() + thread * part, static_cast<int>(thread), part);
  });
  std::vector<float> results(threads);
  double operations = 0.0;
  const double compute = bestSeconds(threads, 300, [&](std::size_t thread) {
    const double done = multiplyAdd(50000, results[thread]);
    if (thread == 0) operations = done * static_cast<double>(threads);
  });
  return {static_cast<double>(kFrameBytes) / fill, operations / compute};
}

void print(int threads, const Rates& rates) {
  const double bytes = kPixels * 8.0 + kPixels / 2.0 * 12.0;
  const double memoryMs = 1e3 * bytes / rates.bytes;
  const double arithmeticMs = 1e3 * kPixels / 2.0 * kOperationsPerPixel / rates.operations;
  std::printf("threads=%d fill_gb_s=%.1f gflop_s=%.1f memory_ms=%.4f arithmetic_ms=%.4f bound_ms=%.4f\n",
              threads, 1e-9 * rates.bytes, 1e-9 * rates.operations, memoryMs, arithmeticMs,
              memoryMs + arithmeticMs);
}

}  // namespace
}  // namespace limn::bench

int main() {
  const limn::bench::Rates one = limn::bench::measure(1), two = limn::bench::measure(2);
  limn::bench::print(1, one);
  limn::bench::print(2, two);
  std::printf("gain_fill=%.3f gain_arithmetic=%.3f\n", two.bytes / one.bytes,
              two.operations / one.operations);
  return 0;
}
