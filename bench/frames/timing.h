// How the frame benchmarks take their times, the same for limn and its peer.
#pragma once

#include <cstdint>
#include <vector>

namespace limn::bench {

/// Wall-clock time and processor time of all threads, in seconds from an arbitrary start.
double wallSeconds();
double processorSeconds();

struct FrameTimes {
  int frames = 0;
  double minMs = 0;     ///< for every view its best frame, averaged over the views
  double medianMs = 0;  ///< of all frames
  double cpuMs = 0;     ///< processor time of all threads, per frame
};

/// Collects the times of frames that go round through the views.
class FrameClock {
 public:
  explicit FrameClock(int views);
  /// Calls drawFrame(view) for `seconds`, at least two turns. What it does besides the call takes no time away.
  template <class DrawFrame>
  FrameTimes run(double seconds, const DrawFrame& drawFrame) {
    const double start = wallSeconds(), processor = processorSeconds();
    while (wallSeconds() - start < seconds || frames() < 2 * views()) {
      const int view = frames() % views();
      const double before = wallSeconds();
      drawFrame(view);
      record(view, wallSeconds() - before);
    }
    return result(processorSeconds() - processor);
  }

 private:
  int views() const { return static_cast<int>(best_.size()); }
  int frames() const { return static_cast<int>(all_.size()); }
  void record(int view, double seconds);
  FrameTimes result(double processor) const;

  std::vector<double> best_, all_;
};

}  // namespace limn::bench
