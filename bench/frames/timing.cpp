#include "bench/frames/timing.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <numeric>

namespace limn::bench {

double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

FrameClock::FrameClock(int views)
    : best_(static_cast<std::size_t>(views), std::numeric_limits<double>::infinity()) {
  all_.reserve(1 << 16);
}

void FrameClock::record(int view, double seconds) {
  all_.push_back(seconds);
  double& best = best_[static_cast<std::size_t>(view)];
  best = std::min(best, seconds);
}

FrameTimes FrameClock::result(double processor) const {
  std::vector<double> sorted = all_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  FrameTimes times;
  times.frames = frames();
  times.minMs = 1e3 * std::accumulate(best_.begin(), best_.end(), 0.0) / views();
  times.medianMs = 1e3 * *middle;
  times.cpuMs = 1e3 * processor / times.frames;
  return times;
}

}  // namespace limn::bench
