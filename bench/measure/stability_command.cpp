// limn_measure stability
#include <cstdio>

#include "bench/measure/command.h"
#include "bench/measure/stability.h"

namespace limn::measure {

int runStability(const Options& options) {
  constexpr std::uint64_t kSeed = 20040601;
  const std::size_t cases = options.quick ? 20000 : 400000;
  std::vector<Json> rows;
  std::fprintf(stderr, "%-34s %12s %12s  %s\n", "kernel", "largest", "bound", "unit");
  const auto tell = [](const char* name, double largest, double bound, const char* unit) {
    std::fprintf(stderr, "%-34s %12.4g %12.4g  %s%s\n", name, largest, bound, unit,
                 largest <= bound ? "" : "  BROKEN");
  };
  for (const auto& checks : {baseChecks(), silhouetteChecks(), rasterChecks()}) {
    for (const KernelCheck& check : checks) {
      const double largest =
          check.largestError(options.seed >= 0 ? static_cast<std::uint64_t>(options.seed) : kSeed, cases);
      tell(check.kernel, largest, check.bound, check.unit);
      rows.push_back({{"kernel", check.kernel},
                      {"unit", check.unit},
                      {"largest", largest},
                      {"bound", check.bound},
                      {"holds", largest <= check.bound},
                      {"cases", cases},
                      {"domain", check.domain},
                      {"outside", check.outside}});
    }
  }
  for (const ExtremeCheck& check : extremeChecks()) {
    const double error = check.error();
    tell(check.name, error, check.bound, check.unit);
    rows.push_back({{"kernel", check.name},
                    {"unit", check.unit},
                    {"largest", error},
                    {"bound", check.bound},
                    {"holds", error <= check.bound},
                    {"cases", 1},
                    {"domain", check.meaning},
                    {"outside", ""}});
  }
  print(rows);
  return 0;
}

}  // namespace limn::measure
