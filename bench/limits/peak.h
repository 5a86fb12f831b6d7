// The arithmetic peak of one core, measured.
#pragma once

#include <cstdint>

namespace limn::bench {

/// Does `rounds` of multiply-adds, says how many floating-point operations that were. `result` keeps them from being
/// left out.
double multiplyAdd(std::int64_t rounds, float& result);

}  // namespace limn::bench
