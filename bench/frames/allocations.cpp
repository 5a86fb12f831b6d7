// The C library's allocator with a counter before it. glibc offers its functions under second names for this purpose;
// operator new calls malloc, so all that asks for memory is seen.
#include "bench/frames/allocations.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define LIMN_COUNTS_ALLOCATIONS 0
#elif defined(__has_feature)
#define LIMN_COUNTS_ALLOCATIONS !__has_feature(address_sanitizer)
#else
#define LIMN_COUNTS_ALLOCATIONS 1
#endif

namespace {
std::atomic<std::uint64_t> count{0};
}  // namespace

namespace limn::bench {
std::uint64_t allocationCount() {
  return count.load(std::memory_order_relaxed);
}
}  // namespace limn::bench

#if LIMN_COUNTS_ALLOCATIONS
extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): glibc's names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  *block = memalign(alignment, size);
  return *block == nullptr && size > 0 ? ENOMEM : 0;
}

}  // extern "C"
#endif
