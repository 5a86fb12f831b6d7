// limn_measure trade
#include <cstdio>
#include <string>

#include "apps/scene/image.h"
#include "bench/measure/command.h"
#include "bench/measure/trade.h"

namespace limn::measure {
namespace {

std::vector<Variant> tradeVariants(Options options) {
  if (!options.tolerancesGiven) {
    options.tolerances = options.quick ? std::vector{1.0, 0.25} : std::vector{2.0, 1.0, 0.5, 0.25, 0.1, 0.05};
  }
  if (!options.methods.empty()) return makeVariants(options, options.methods);
  std::vector<Variant> variants = makeVariants(options, {"flat", "patches", "curves"});
  // PN triangles at their counts: a tolerance has no hold on a uniform refinement's silhouette.
  const auto counts = options.quick ? std::vector<std::string>{"pn:2", "pn:8"}
                                    : std::vector<std::string>{"pn:2", "pn:3", "pn:4", "pn:8", "pn:16"};
  for (Variant& variant : makeVariants(options, counts)) variants.push_back(std::move(variant));
  return variants;
}

Json jsonOf(const TradeRow& row) {
  const AccuracyRow& a = row.accuracy;
  return {{"model", a.model},
          {"method", a.method},
          {"tolerance", rounded(a.tolerance)},
          {"views", a.views},
          {"mean_px", rounded(a.mean)},
          {"p95_px", rounded(a.p95)},
          {"max_px", rounded(a.max)},
          {"flat_mean_px", rounded(a.flatMean)},
          {"removed", rounded(a.removed())},
          {"views_worse_than_flat", a.viewsWorseThanFlat},
          {"triangles", rounded(a.triangles)},
          {"frame_min_ms", rounded(row.cost.minMs)},
          {"frame_median_ms", rounded(row.cost.medianMs)},
          {"refine_ms", rounded(row.cost.refineMs)},
          {"cost", rounded(row.costRatio)},
          {"pareto", row.pareto},
          {"disturbed", row.cost.disturbed()}};
}

void tell(const TradeRow& row) {
  const AccuracyRow& a = row.accuracy;
  std::fprintf(stderr, "%-22s %-10s %6g %9.3f px %7.1f%% %9.3f ms %7.2fx %9.1f %s%s\n", a.model.c_str(),
               a.method.c_str(), a.tolerance, a.mean, 100 * a.removed(), row.cost.minMs, row.costRatio,
               a.triangles, row.pareto ? "*" : "", row.cost.disturbed() ? " (disturbed)" : "");
}

// One block of lines per method: cost, share of the flat error left, tolerance, segments label, front.
void writePlotTable(const std::string& file, const std::vector<TradeRow>& rows) {
  std::string text = "# cost  error_left_percent  label  pareto\n", method;
  for (const TradeRow& row : rows) {
    const std::string family = row.accuracy.method.substr(0, row.accuracy.method.find(':'));
    if (family != method) text += (method.empty() ? "" : "\n\n") + ("# " + family + "\n");
    method = family;
    char label[32];
    std::snprintf(label, sizeof label, "%g", row.accuracy.tolerance);
    const std::size_t colon = row.accuracy.method.find(':');
    const std::string name = family == "flat"             ? "flat"
                             : colon == std::string::npos ? label
                                                          : row.accuracy.method.substr(colon + 1);
    char line[128];
    std::snprintf(line, sizeof line, "%.5f %.5f %s %d\n", row.costRatio, 100 * (1 - row.accuracy.removed()),
                  name.c_str(), row.pareto ? 1 : 0);
    text += line;
  }
  scene::writeFileWhole(file, text.data(), text.size());
}

}  // namespace

int runTrade(const Options& options) {
  const std::vector<Variant> variants = tradeVariants(options);
  const std::vector<glm::dvec3> directions = makeDirections(options);
  // The baseline of the cost is drawn in the same turns as the variants.
  std::vector<Variant> timed = makeVariants(options, {"flat"});
  timed.insert(timed.end(), variants.begin(), variants.end());
  Workers workers(threadsOf(options));
  std::vector<std::vector<TradeRow>> analytic, modelled;
  std::vector<Json> rows;
  const auto report = [&](const std::vector<TradeRow>& some) {
    for (const TradeRow& row : some) {
      tell(row);
      rows.push_back(jsonOf(row));
    }
  };
  forSubjects(options, [&](const Subject& subject) {
    const Accuracy accuracy = measureAccuracy(subject, variants, directions, options.size, workers);
    const std::vector<Cost> costs = measureCosts(subject.pair.model, timed, options.quick ? 2 : 6,
                                                 options.quick ? 5 : 9, threadsOf(options));
    std::vector<TradeRow> some;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      TradeRow row{summarize(subject, variants[v], accuracy, v), costs[v + 1]};
      row.costRatio = row.cost.minMs / costs[0].minMs;
      some.push_back(row);
    }
    markPareto(some);
    report(some);
    (subject.pair.analytic ? analytic : modelled).push_back(std::move(some));
  });
  for (const auto& [models, name] :
       {std::pair{&analytic, "pooled:analytic"}, {&modelled, "pooled:modelled"}}) {
    const std::vector<TradeRow> pooled = pool(*models, name);
    if (models->size() > 1) report(pooled);
    if (options.plotFolder.empty() || pooled.empty()) continue;
    writePlotTable(options.plotFolder + "/trade-" + std::string(name).substr(7) + ".dat", pooled);
  }
  print(rows);
  return 0;
}

}  // namespace limn::measure
