// methods/5-measures.md, 5.4: accuracy against cost, and the choices that no other choice beats on both.
#pragma once

#include <vector>

#include "bench/measure/accuracy.h"
#include "bench/measure/cost.h"

namespace limn::measure {

struct TradeRow {
  AccuracyRow accuracy;
  Cost cost;
  double costRatio = 1.0;  ///< frame time over the flat mesh's, same run
  bool pareto = false;
};

/// Marks the rows that no other beats: none is at least as good in both and better in one.
void markPareto(std::vector<TradeRow>& rows);

/// The rows of several models put together, variant by variant: sums of the offsets, geometric means of the cost ratios.
/// Every model has the same variants in the same order.
std::vector<TradeRow> pool(const std::vector<std::vector<TradeRow>>& models, const std::string& name);

}  // namespace limn::measure
