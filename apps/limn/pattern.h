// Where frames go: "frames/%04d.png", "frames/####.png", one plain name, or "-" for standard output.
#pragma once

#include <string>
#include <string_view>

namespace limn::program {

class OutputPattern {
 public:
  /// Throws UsageError for a pattern with two numbers or an unknown "%" sequence. "%%" stands for a percent sign.
  explicit OutputPattern(std::string_view text);

  bool isStandardOutput() const { return standardOutput_; }
  bool hasNumber() const { return digits_ >= 0; }
  /// The file of a frame; the plain name where there is no number.
  std::string path(int frame) const;

 private:
  std::string before_, after_;
  int digits_ = -1;  ///< least digits of the number, -1: no number
  bool standardOutput_ = false;
};

/// "a/b.png" and "depth" make "a/b.depth.png".
std::string besidePath(const std::string& path, std::string_view kind);

}  // namespace limn::program
