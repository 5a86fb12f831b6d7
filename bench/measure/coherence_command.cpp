// limn_measure coherence
#include <cstdio>

#include "bench/measure/coherence.h"
#include "bench/measure/command.h"

namespace limn::measure {

int runCoherence(const Options& options) {
  const std::vector<std::string> methods =
      options.methods.empty() ? std::vector<std::string>{"flat", "patches", "curves", "pn"} : options.methods;
  const std::vector<Variant> variants = makeVariants(options, methods);
  Workers workers(threadsOf(options));
  std::vector<Json> rows;
  std::fprintf(stderr, "%-22s %-18s %6s %6s %7s %9s %9s %9s %9s\n", "model", "method", "tol", "step",
               "frames", "change", "true", "pop_px", "local_px");
  forSubjects(options, [&](const Subject& subject) {
    for (const double step : options.steps) {
      const Path path{options.quick ? options.arc / 3 : options.arc, step};
      const std::vector<Coherence> measured =
          measureCoherence(subject, variants, path, options.size, workers);
      for (std::size_t v = 0; v < variants.size(); ++v) {
        const Coherence& c = measured[v];
        const double tolerance = variants[v].parameters.tolerance;
        std::fprintf(stderr, "%-22s %-18s %6g %6g %7zu %9.4f %9.4f %9.4f %9.4f\n", subject.pair.name.c_str(),
                     variants[v].name.c_str(), tolerance, step, path.steps() + 1, c.change, c.trueChange,
                     c.pop, c.localPop);
        rows.push_back({{"model", subject.pair.name},
                        {"method", variants[v].name},
                        {"tolerance", rounded(tolerance)},
                        {"step_deg", rounded(step)},
                        {"frames", path.steps() + 1},
                        {"pop_px", rounded(c.pop)},
                        {"local_pop_px", rounded(c.localPop)},
                        {"change_px", rounded(c.change)},
                        {"true_change_px", rounded(c.trueChange)}});
      }
    }
  });
  print(rows);
  return 0;
}

}  // namespace limn::measure
