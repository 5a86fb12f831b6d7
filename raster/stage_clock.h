// Times of stages within a tile.
#pragma once

#include <chrono>

namespace limn::raster {

/// Takes the time from one stage to the next, where anybody wants to know it.
class StageClock {
 public:
  StageClock() = default;
  static StageClock started(bool wanted) {
    StageClock clock;
    clock.wanted_ = wanted;
    if (wanted) clock.last_ = Clock::now();
    return clock;
  }
  /// Adds the time since the last lap, or the start, to `ms`.
  void lap(double& ms) {
    if (!wanted_) return;
    const Clock::time_point now = Clock::now();
    ms += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point last_;
  bool wanted_ = false;
};

}  // namespace limn::raster
