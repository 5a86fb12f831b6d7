// Lists whose length is known only when they are made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "silhouette/method.h"

namespace limn::silhouette {

/// Makes `out` of what fill(item, at) writes from out[at] on for every item in order, count(item) things, and only if there
/// are any. Counts, sums and fills by blocks of items, so the list is the same for any number of threads. `starts` is scratch
/// memory.
template <class T, class Count, class Fill>
void collect(const Crew& crew, std::size_t items, std::vector<std::uint32_t>& starts, std::vector<T>& out,
             const Count& count, const Fill& fill) {
  constexpr std::size_t kItemsPerBlock = 4096;
  starts.assign((items + kItemsPerBlock - 1) / kItemsPerBlock + 1, 0);
  crew.forBlocks(items, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t sum = 0;
    for (std::size_t item = begin; item < end; ++item) sum += count(item);
    starts[begin / kItemsPerBlock + 1] = sum;
  });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  out.resize(starts.back());
  crew.forBlocks(items, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t at = starts[begin / kItemsPerBlock];
    for (std::size_t item = begin; item < end; ++item)
      if (const std::uint32_t wanted = count(item); wanted > 0) {
        fill(item, at);
        at += wanted;
      }
  });
}

}  // namespace limn::silhouette
