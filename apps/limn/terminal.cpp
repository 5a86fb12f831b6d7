#include "apps/limn/terminal.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace limn::program {
namespace {

bool isTerminal() {
  return ::isatty(STDERR_FILENO) == 1;
}

bool wantsColor() {
  const char* noColor = std::getenv("NO_COLOR");
  return isTerminal() && (noColor == nullptr || *noColor == '\0');
}

// One call per line, so that lines of several threads and processes do not mix.
void print(const std::string& text) {
  const std::string line = (isTerminal() ? "\r\x1b[K" : "") + text + "\n";  // over the progress line
  std::fwrite(line.data(), 1, line.size(), stderr);
}

std::string duration(double seconds) {
  std::array<char, 32> text{};
  if (seconds < 99.5)
    std::snprintf(text.data(), text.size(), "%.0f s", seconds);
  else if (seconds < 5970.0)
    std::snprintf(text.data(), text.size(), "%.0f min", seconds / 60.0);
  else
    std::snprintf(text.data(), text.size(), "%.1f h", seconds / 3600.0);
  return text.data();
}

}  // namespace

void printError(const std::string& message) {
  print(wantsColor() ? "limn: \x1b[1;31merror:\x1b[0m " + message : "limn: error: " + message);
}

void printMessage(const std::string& message) {
  print("limn: " + message);
}

Progress::Progress(int total, bool quiet)
    : total_(total), enabled_(!quiet && isTerminal()), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

bool Progress::isDue() {
  const Clock::time_point now = Clock::now();
  const auto since = [now](Clock::time_point then) {
    return std::chrono::duration<double>(now - then).count();
  };
  if (!enabled_ || since(start_) < 1.0 || (shown_ && since(last_) < 0.1)) return false;
  last_ = now;
  return shown_ = true;
}

void Progress::showPart(double part) {
  if (isDue()) std::fprintf(stderr, "\r\x1b[Klimn: %.0f %%", 100.0 * part);
}

void Progress::show(int done, int skipped) {
  if (!isDue()) return;
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  const double rate = (done - skipped) / elapsed;
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "\r\x1b[Klimn: %d of %d frames, %.1f per second, %s left", done,
                total_, rate, rate > 0.0 ? duration((total_ - done) / rate).c_str() : "?");
  std::fputs(text.data(), stderr);
}

}  // namespace limn::program
