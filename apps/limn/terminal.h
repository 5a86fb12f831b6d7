// What people see: messages and progress on standard error.
#pragma once

#include <chrono>
#include <string>

namespace limn::program {

/// "limn: error: ..." in colour on a terminal unless NO_COLOR is set.
void printError(const std::string& message);
/// "limn: ..."
void printMessage(const std::string& message);

/// A line with the rate and the time left, on a terminal only, after the first second.
class Progress {
 public:
  Progress(int total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` frames of the total are drawn, `skipped` of them were there already.
  void show(int done, int skipped);
  /// For work that has no frames: `part` of it, 0 to 1, is done.
  void showPart(double part);

 private:
  /// Whether it is time for another line.
  bool isDue();

  using Clock = std::chrono::steady_clock;
  int total_;
  bool enabled_;
  bool shown_ = false;
  Clock::time_point start_, last_;
};

}  // namespace limn::program
