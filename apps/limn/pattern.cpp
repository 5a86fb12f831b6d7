#include "apps/limn/pattern.h"

#include <algorithm>
#include <cctype>

#include "apps/limn/values.h"

namespace limn::program {
namespace {

constexpr int kMostDigits = 20;

/// Reads "%04d" behind the percent sign; the number of characters taken, 0 if it is something else.
std::size_t readConversion(std::string_view text, int& digits) {
  std::size_t at = 0;
  digits = 0;
  while (at < text.size() && at < 3 && std::isdigit(static_cast<unsigned char>(text[at])) != 0)
    digits = 10 * digits + (text[at++] - '0');
  const bool zeros = at == 0 || text[0] == '0';
  return zeros && at < text.size() && text[at] == 'd' && digits <= kMostDigits ? at + 1 : 0;
}

}  // namespace

OutputPattern::OutputPattern(std::string_view text) : standardOutput_(text == "-") {
  if (text.empty()) throw UsageError("the output has no name");
  const auto startNumber = [&](int digits) {
    if (hasNumber())
      throw UsageError("the pattern '" + std::string(text) + "' has two numbers; one is the frame's");
    digits_ = digits;
  };
  for (std::size_t at = 0; at < text.size();) {
    std::string& part = hasNumber() ? after_ : before_;
    const std::string_view rest = text.substr(at);
    int digits = 0;
    if (rest.starts_with("%%")) {
      part += '%';
      at += 2;
    } else if (rest[0] == '%') {
      const std::size_t taken = readConversion(rest.substr(1), digits);
      if (taken == 0)
        throw UsageError("the pattern '" + std::string(text) +
                         "' has a % that is no frame number; write %04d, or %% for a percent sign");
      startNumber(digits);
      at += 1 + taken;
    } else if (rest[0] == '#') {
      const std::size_t run = std::min(rest.find_first_not_of('#'), rest.size());
      startNumber(static_cast<int>(std::min<std::size_t>(run, kMostDigits)));
      at += run;
    } else {
      part += rest[0];
      ++at;
    }
  }
}

std::string OutputPattern::path(int frame) const {
  if (!hasNumber()) return before_;
  std::string number = std::to_string(frame);
  const auto digits = static_cast<std::size_t>(digits_);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return before_ + number + after_;
}

std::string besidePath(const std::string& path, std::string_view kind) {
  const std::size_t slash = path.rfind('/');
  const std::size_t dot = path.rfind('.');
  const bool hasExtension =
      dot != std::string::npos && (slash == std::string::npos || dot > slash + 1) && dot > 0;
  const std::string extension = hasExtension ? path.substr(dot) : ".png";
  std::string name = hasExtension ? path.substr(0, dot) : path;
  return name.append(1, '.').append(kind).append(extension);
}

}  // namespace limn::program
