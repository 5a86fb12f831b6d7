// Scratch memory that the threads of a frame have one slot each of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace limn {

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
