#include "raster/base/check.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace limn {

void detail::requirementFailed(std::string_view what, const char* function) {
  throw std::invalid_argument(std::string(function) + ": " + std::string(what));
}

void detail::assertionFailed(const char* condition, const char* file, int line, const double* values,
                             int count) {
  std::fprintf(stderr, "limn: assertion failed: %s (%s:%d)", condition, file, line);
  for (int i = 0; i < count; ++i) std::fprintf(stderr, "%s%.17g", i == 0 ? " with " : ", ", values[i]);
  std::fputc('\n', stderr);
  std::abort();
}

}  // namespace limn
