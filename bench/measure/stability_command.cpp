// limn_measure stability
#include <algorithm>
#include <cstdio>

#include "bench/measure/command.h"
#include "bench/measure/stability.h"

namespace limn::measure {
namespace {

struct Result {
  const char* name;
  const char* unit;
  double largest, bound;
  std::size_t cases;
  const char* domain;
  const char* outside;
};

// Says it, and makes a row of it.
Json rowOf(const Result& r) {
  const bool holds = r.largest <= r.bound;
  std::fprintf(stderr, "%-34s %12.4g %12.4g  %s%s\n", r.name, r.largest, r.bound, r.unit,
               holds ? "" : "  BROKEN");
  return {{"kernel", r.name}, {"unit", r.unit},   {"largest", r.largest}, {"bound", r.bound},
          {"holds", holds},   {"cases", r.cases}, {"domain", r.domain},   {"outside", r.outside}};
}

}  // namespace

int runStability(const Options& options) {
  constexpr std::uint64_t kSeed = 20040601;
  const std::size_t cases = options.quick ? 20000 : 400000;
  const std::uint64_t seed = options.seed >= 0 ? static_cast<std::uint64_t>(options.seed) : kSeed;
  std::vector<Json> rows;
  std::fprintf(stderr, "%-34s %12s %12s  %s\n", "kernel", "largest", "bound", "unit");
  for (const auto& checks : {baseChecks(), silhouetteChecks(), rasterChecks()}) {
    for (const KernelCheck& check : checks) {
      rows.push_back(rowOf({.name = check.kernel,
                            .unit = check.unit,
                            .largest = check.largestError(seed, cases),
                            .bound = check.bound,
                            .cases = cases,
                            .domain = check.domain,
                            .outside = check.outside}));
    }
  }
  for (const ExtremeCheck& check : extremeChecks()) {
    rows.push_back(rowOf({.name = check.name,
                          .unit = check.unit,
                          .largest = check.error(),
                          .bound = check.bound,
                          .cases = 1,
                          .domain = check.meaning,
                          .outside = ""}));
  }
  print(rows);
  const bool allHold =
      std::all_of(rows.begin(), rows.end(), [](const Json& row) { return row["holds"].get<bool>(); });
  return allHold ? 0 : 1;
}

}  // namespace limn::measure
