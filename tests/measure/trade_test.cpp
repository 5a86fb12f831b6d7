#include "bench/measure/trade.h"

#include <gtest/gtest.h>

namespace limn::measure {
namespace {

TradeRow row(double error, double cost) {
  TradeRow out;
  out.accuracy.mean = error;
  out.accuracy.flatMean = 4.0;
  out.costRatio = cost;
  return out;
}

TEST(MarkPareto, KeepsWhatNothingBeats) {
  std::vector<TradeRow> rows{row(4, 1),   row(2, 1.5),   row(2, 2), row(3, 1.5),
                             row(0.5, 3), row(0.6, 2.9), row(1, 4)};
  markPareto(rows);
  const std::vector<bool> expected{true, true, false, false, true, true, false};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].pareto, expected[i]) << i;
}

TEST(MarkPareto, KeepsBothOfTwoEqualRows) {
  std::vector<TradeRow> rows{row(1, 2), row(1, 2)};
  markPareto(rows);
  EXPECT_TRUE(rows[0].pareto && rows[1].pareto);
}

TEST(Pool, SumsOffsetsAndAveragesRatios) {
  const std::vector<TradeRow> pooled = pool({{row(4, 1), row(1, 2)}, {row(4, 1), row(3, 8)}}, "all");
  ASSERT_EQ(pooled.size(), 2u);
  EXPECT_DOUBLE_EQ(pooled[1].accuracy.removed(), 0.5);
  EXPECT_DOUBLE_EQ(pooled[1].costRatio, 4.0);
  EXPECT_DOUBLE_EQ(pooled[0].accuracy.removed(), 0.0);
  EXPECT_TRUE(pool({}, "none").empty());
}

// The flat mesh beside itself costs what it costs.
TEST(MeasureCosts, OfTheSameThingTwiceAreAlike) {
  Variant flat{"flat", {}};
  flat.parameters.method = silhouette::Method::kFlat;
  const std::vector<Cost> costs = measureCosts("builtin:icosphere-320", {flat, flat}, 1, 15, 1);
  EXPECT_GT(costs[0].minMs, 0.0);
  EXPECT_EQ(costs[0].triangles, costs[1].triangles);
  EXPECT_NEAR(costs[1].minMs / costs[0].minMs, 1.0, 0.5);
}

}  // namespace
}  // namespace limn::measure
