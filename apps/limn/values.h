// What stands behind an option, read strictly: the whole text must make sense, numbers must be finite.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::program {

/// A command line that cannot be obeyed: what is wrong and what to write instead. Exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr int kMostFrames = 10'000'000;  ///< of a job

double parseNumber(std::string_view text);
long parseInteger(std::string_view text, long least, long most);

/// "x,y,z"
glm::dvec3 parseVector(std::string_view text);

/// "1280x800", each side 1 … 16384.
std::pair<int, int> parseSize(std::string_view text);

/// "#rgb", "#rrggbb", "#rrggbbaa", one of the sixteen names of HTML 4, or "transparent"; as linear RGB with straight
/// alpha.
glm::vec4 parseColor(std::string_view text);

/// The colour as "#rrggbbaa", which parseColor understands.
std::string colorText(const glm::vec4& linear);

/// "A:B" in seconds, A <= B.
std::pair<double, double> parseTimes(std::string_view text);

/// "I/N", 1 <= I <= N.
std::pair<int, int> parseShard(std::string_view text);

/// Consecutive frames first, first + step, … up to last.
struct FrameRange {
  int first = 1, last = 1, step = 1;
  int count() const { return (last - first) / step + 1; }
};

/// "1-10,15,20-40:2": frames in the order given, the first of a job is 1. A frame named twice is an error.
class FrameList {
 public:
  /// All frames of a job.
  static FrameList all(int count) { return FrameList({{1, count, 1}}); }
  static FrameList parse(std::string_view text);

  int count() const { return count_; }
  int largest() const;
  int at(int position) const;  ///< position 0 … count() - 1
  std::string text() const;

 private:
  explicit FrameList(std::vector<FrameRange> ranges);
  std::vector<FrameRange> ranges_;
  int count_ = 0;
};

/// One of `names` by its place in the list; the message for another one suggests the nearest.
int parseChoice(std::string_view text, std::span<const std::string> names);

/// "depth,id": some of `names`, in the order given, none twice.
std::vector<int> parseChoices(std::string_view text, std::span<const std::string> names);

/// The shortest text that reads back as the same number.
std::string numberText(double value);
std::string numberText(float value);
std::string vectorText(const glm::dvec3& value);

}  // namespace limn::program
