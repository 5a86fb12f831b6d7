#include "bench/measure/trade.h"

#include <algorithm>
#include <cmath>

namespace limn::measure {

void markPareto(std::vector<TradeRow>& rows) {
  const auto beats = [](const TradeRow& a, const TradeRow& b) {
    const double ea = a.accuracy.mean, eb = b.accuracy.mean;
    return ea <= eb && a.costRatio <= b.costRatio && (ea < eb || a.costRatio < b.costRatio);
  };
  for (TradeRow& row : rows) {
    row.pareto =
        std::none_of(rows.begin(), rows.end(), [&](const TradeRow& other) { return beats(other, row); });
  }
}

std::vector<TradeRow> pool(const std::vector<std::vector<TradeRow>>& models, const std::string& name) {
  std::vector<TradeRow> pooled;
  if (models.empty()) return pooled;
  for (std::size_t v = 0; v < models.front().size(); ++v) {
    TradeRow sum;
    sum.accuracy.model = name;
    sum.accuracy.method = models.front()[v].accuracy.method;
    sum.accuracy.tolerance = models.front()[v].accuracy.tolerance;
    double logarithms = 0.0;
    for (const std::vector<TradeRow>& rows : models) {
      const AccuracyRow& a = rows[v].accuracy;
      sum.accuracy.mean += a.mean;
      sum.accuracy.p95 += a.p95;
      sum.accuracy.max = std::max(sum.accuracy.max, a.max);
      sum.accuracy.corner = std::max(sum.accuracy.corner, a.corner);
      sum.accuracy.flatMean += a.flatMean;
      sum.accuracy.views += a.views;
      sum.accuracy.viewsWorseThanFlat += a.viewsWorseThanFlat;
      sum.accuracy.triangles += a.triangles;
      sum.cost.minMs += rows[v].cost.minMs;
      sum.cost.medianMs += rows[v].cost.medianMs;
      sum.cost.refineMs += rows[v].cost.refineMs;
      logarithms += std::log(rows[v].costRatio);
    }
    sum.costRatio = std::exp(logarithms / static_cast<double>(models.size()));
    pooled.push_back(sum);
  }
  markPareto(pooled);
  return pooled;
}

}  // namespace limn::measure
