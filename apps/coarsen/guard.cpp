// Based on: nothing published. A patch is looked at on a grid of its parameters. It folds where its normal turns by more
// than 80 degrees from one point of the grid to the next, which no fitted surface does over a tenth of its size.
#include "apps/coarsen/guard.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn::coarsen {
namespace {

using glm::dvec3;

constexpr int kGrid = 10;
constexpr std::size_t kPatchesPerBlock = 8;
constexpr double kSharpestTurn = 0.1736;  // cos 80°

struct Look {
  double distance = 0.0;
  bool folds = false;
};

// The farthest point of the patch (or, `flat`, of its flat triangle) from the surface.
double farthest(const ClosestPoint& closest, const PatchNet& net, std::size_t t, bool flat) {
  const Index* p = &net.corners()[3 * t];
  double distance2 = 0.0;
  for (int i = 0; i <= kGrid; ++i)
    for (int j = 0; j <= i; ++j) {
      const double u = 1.0 - static_cast<double>(i) / kGrid, w = static_cast<double>(j) / kGrid,
                   v = 1.0 - u - w;
      const dvec3 point = flat ? u * net.controls[p[0]] + v * net.controls[p[1]] + w * net.controls[p[2]]
                               : net.evaluate(t, bernstein(u, v, w));
      if (const std::optional<Touch> touch = closest.find(point))
        distance2 = std::max(distance2, touch->distance2);
    }
  return std::sqrt(distance2);
}

bool folds(const PatchNet& net, std::size_t t) {
  std::array<std::array<dvec3, kGrid + 1>, kGrid + 1> normals;
  const auto turns = [](const dvec3& a, const dvec3& b) {
    const double scale = glm::length(a) * glm::length(b);
    return !(glm::dot(a, b) >= kSharpestTurn * scale) || scale == 0.0;
  };
  for (std::size_t i = 0; i <= kGrid; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double u = 1.0 - static_cast<double>(i) / kGrid, w = static_cast<double>(j) / kGrid;
      normals[i][j] = net.normal(t, u, 1.0 - u - w, w);
      if (i > 0 && j < i && turns(normals[i][j], normals[i - 1][j])) return true;
      if (j > 0 && turns(normals[i][j], normals[i][j - 1])) return true;
    }
  return false;
}

// Brings what a patch adds to its flat triangle down to `part` of it.
void flatten(PatchNet& net, std::size_t t, double part) {
  const dvec3 bulge = net.controls[net.centerControl(t)] - net.defaultCenter(t);
  const PerControl<Index> id = net.controlsOf(t);
  static constexpr std::array<std::array<std::size_t, 3>, 6> kEnds = {
      {{3, 0, 1}, {4, 1, 0}, {5, 1, 2}, {6, 2, 1}, {7, 2, 0}, {8, 0, 2}}};
  for (const auto& [end, near, far] : kEnds) {
    const dvec3 straight = (2.0 * net.controls[id[near]] + net.controls[id[far]]) / 3.0;
    net.controls[id[end]] = straight + part * (net.controls[id[end]] - straight);
  }
  net.controls[net.centerControl(t)] = net.defaultCenter(t) + part * bulge;
}

}  // namespace

GuardReport guardPatches(const Surface& surface, Workers& workers, PatchNet& net) {
  dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const dvec3& p : surface.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const std::size_t count = net.triangleCount();
  const double stated = count == 0 ? 0.0 : kFarthestPatch * 0.5 * glm::length(high - low);
  const ClosestPoint closest(surface.points, surface.corners);
  std::vector<double> limits(count);
  std::vector<Look> looks(count);
  const auto look = [&](bool first) {
    workers.forBlocks(count, kPatchesPerBlock, [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t t = begin; t < end; ++t) {
        if (first) limits[t] = std::max(stated, farthest(closest, net, t, true) * (1.0 + 1e-9));
        looks[t] = {farthest(closest, net, t, false), folds(net, t)};
      }
    });
  };
  look(true);

  std::vector<bool> mended(count, false), straight(count, false);
  constexpr int kGentleRounds = 4;  // that halve; from there on patches become flat
  for (int round = 0;; ++round) {
    bool any = false;
    for (std::size_t t = 0; t < count; ++t) {
      if (straight[t] || (!looks[t].folds && looks[t].distance <= limits[t])) continue;
      any = mended[t] = true;
      straight[t] = round >= kGentleRounds;
      flatten(net, t, straight[t] ? 0.0 : 0.5);
    }
    if (!any) break;
    look(false);
  }

  GuardReport report;
  report.limit = stated;
  for (std::size_t t = 0; t < count; ++t) {
    report.limit = std::max(report.limit, limits[t]);
    report.farthest = std::max(report.farthest, looks[t].distance);
    if (mended[t]) ++report.mended;
    if (straight[t]) ++report.straightened;
  }
  return report;
}

}  // namespace limn::coarsen
