// The threads that a renderer or a refinement works with.
//
// Work is split by index, never by the number of threads, and every block writes to places of its own, so
// results do not depend on how many threads there are or which one ran a block.
#pragma once

#include <cstddef>
#include <memory>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace tbb::detail::d1 {
class global_control;
}

namespace limn {

class Workers {
 public:
  /// 1 … 1024 threads work in all, the calling one included, cores or not. Others: std::invalid_argument.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }

  /// Calls body(begin, end, slot) for blocks that make up [0, count). A block holds at most `grain` indices and
  /// starts at a multiple of it. `slot` < threads() names scratch memory that no other block uses at the time.
  template <class Body>
  void forBlocks(std::size_t count, std::size_t grain, const Body& body) {
    if (count == 0) return;
    const std::size_t blocks = (count + grain - 1) / grain;
    const auto run = [&](std::size_t block, int slot) {
      const std::size_t begin = block * grain;
      body(begin, begin + grain < count ? begin + grain : count, slot);
    };
    if (threads_ == 1 || blocks == 1) {
      for (std::size_t block = 0; block < blocks; ++block) run(block, 0);
      return;
    }
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, blocks, 1),
          [&](const tbb::blocked_range<std::size_t>& range) {
            const int slot = tbb::this_task_arena::current_thread_index();
            for (std::size_t block = range.begin(); block != range.end(); ++block) run(block, slot);
          },
          tbb::simple_partitioner());
    });
  }

 private:
  int threads_;
  tbb::task_arena arena_;
  std::unique_ptr<tbb::detail::d1::global_control> control_;  // lets TBB have as many workers as asked for
};

/// How many threads this process may use: its CPU affinity and its control group's quota; at most 1024.
int availableThreads();

}  // namespace limn
