// Counts heap allocations of the whole process, all threads.
#pragma once

#include <cstdint>

namespace limn::bench {

/// Calls of malloc and its relatives so far, operator new among them; 0 for ever where they are not counted (under the
/// sanitizers, which bring an allocator of their own).
std::uint64_t allocationCount();

}  // namespace limn::bench
