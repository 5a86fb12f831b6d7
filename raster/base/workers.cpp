#include "raster/base/workers.h"

#include <sched.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#include <tbb/global_control.h>

#include "raster/base/check.h"

namespace limn {
namespace {

constexpr int kMostThreads = 1024;

int checkedThreads(int threads) {
  require(threads >= 1 && threads <= kMostThreads, "threads must be 1 to 1024");
  return threads;
}

// The quota of control group version 2, "MAX PERIOD" in microseconds or "max PERIOD"; 0 where there is none.
int controlGroupQuota() {
  std::ifstream file("/sys/fs/cgroup/cpu.max");
  std::string quota;
  double period = 0.0;
  if (!(file >> quota >> period) || quota == "max" || period <= 0.0) return 0;
  return std::max(1, static_cast<int>(std::stod(quota) / period));
}

}  // namespace

Workers::Workers(int threads) : threads_(checkedThreads(threads)), arena_(threads, 1) {
  // The least of all controls that live counts, so a control for few threads would slow other renderers down.
  const auto count = static_cast<std::size_t>(threads);
  if (count > tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))
    control_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
  arena_.initialize();
}

Workers::~Workers() = default;

int availableThreads() {
  cpu_set_t set;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (sched_getaffinity(0, sizeof set, &set) == 0) threads = CPU_COUNT(&set);
  if (const int quota = controlGroupQuota(); quota > 0) threads = std::min(threads, quota);
  return std::clamp(threads, 1, kMostThreads);
}

}  // namespace limn
