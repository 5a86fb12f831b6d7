// Two tiers of checks (the third, a user's mistake, is a message of the program):
//   limn::require(...)  a caller's mistake: throws std::invalid_argument at a public function's entry
//   LIMN_ASSERT(...)    what cannot happen: prints its values and aborts; compiled out with NDEBUG
#pragma once

#include <string_view>

namespace limn {

namespace detail {
[[noreturn]] void requirementFailed(std::string_view what, const char* function);
[[noreturn]] void assertionFailed(const char* condition, const char* file, int line, const double* values,
                                  int count);
template <class... T>
[[noreturn]] void assertionFailed(const char* condition, const char* file, int line, T... values) {
  const double array[] = {0.0, static_cast<double>(values)...};
  assertionFailed(condition, file, line, array + 1, static_cast<int>(sizeof...(values)));
}
}  // namespace detail

/// Throws std::invalid_argument("FUNCTION: what") unless `holds`. (The builtin is known to g++ and clang++ alike; clang++
/// before 15 lacks what std::source_location needs. Inline, so that compilers and analysers see what holds afterwards.)
inline void require(bool holds, std::string_view what, const char* function = __builtin_FUNCTION()) {
  if (!holds) detail::requirementFailed(what, function);
}

}  // namespace limn

/// LIMN_ASSERT(condition, value...): the numbers named after the condition are printed when it fails.
#ifdef NDEBUG
#define LIMN_ASSERT(condition, ...) static_cast<void>(0)
#else
#define LIMN_ASSERT(condition, ...)   \
  ((condition) ? static_cast<void>(0) \
               : ::limn::detail::assertionFailed(#condition, __FILE__, __LINE__ __VA_OPT__(, ) __VA_ARGS__))
#endif
