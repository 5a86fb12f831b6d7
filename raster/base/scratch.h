// Scratch memory that the threads of a frame have one slot each of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <new>
#include <vector>

namespace limn {

/// Memory at the beginning of a cache line, which is also what the longest vectors want.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  CacheLineAllocator() = default;
  template <class U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>& /*other*/) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
  void deallocate(T* memory, std::size_t /*count*/) { ::operator delete(memory, kAlignment); }
  bool operator==(const CacheLineAllocator& /*other*/) const { return true; }
};
template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// Gives a vector of every slot the capacity of the largest of them, for each of `vectors` (pointers to members, or
/// functions from slot to vector). Which thread works on what differs from frame to frame; after this a frame like the
/// ones before finds room enough in any slot.
template <class Slots, class... Vectors>
void levelCapacity(Slots& slots, const Vectors&... vectors) {
  const auto level = [&](const auto& vectorOf) {
    std::size_t most = 0;
    for (auto& slot : slots) most = std::max(most, std::invoke(vectorOf, slot).capacity());
    for (auto& slot : slots) std::invoke(vectorOf, slot).reserve(most);
  };
  (level(vectors), ...);
}

}  // namespace limn
