// Based on: the coarea formula. Moving a surface by δ(x) along its normals changes the area enclosed by its outline,
// summed over all orthographic views, by  ∫ |δ(x)| K(x) dA,  where K(x) is the mean over the tangent directions of
// the normal curvature there, counted only where the line of sight leaves freely on both sides. So K is the weight
// that turns a fit of a surface into a fit of its outlines.
// Differs in: K is not computed from curvatures, which scanned surfaces do not have, but counted: the surface is drawn
// along many directions, and the triangles that make the outline's pixels get a point each.
#include "apps/coarsen/outline_weight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "apps/coarsen/spans.h"
#include "raster/base/elementary.h"

namespace limn::coarsen {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kDirections = 64;  // of a half sphere: an orthographic outline is the same from behind
constexpr int kSize = 384;       // pixels across the bounding sphere
constexpr int kSmoothings = 6;   // of the counts over neighbouring triangles

struct Picture {
  std::vector<Index> triangle = std::vector<Index>(kSize * kSize);
  std::vector<dvec2> projected;
};

// A spiral over the half sphere.
dvec3 direction(int k) {
  const double z = 1.0 - (k + 0.5) / kDirections, radius = std::sqrt(1.0 - z * z);
  const SinCos turn = sinCos(2.399963229728653 * k);  // the golden angle
  return {radius * turn.cos, radius * turn.sin, z};
}

void project(const Surface& surface, const dvec3& along, const dvec3& center, double scale,
             std::vector<dvec2>& out) {
  const dvec3 helper = std::abs(along.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 right = glm::normalize(glm::cross(helper, along)), up = glm::cross(along, right);
  out.resize(surface.points.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const dvec3 d = surface.points[i] - center;
    out[i] = dvec2(0.5 * kSize) + scale * dvec2(glm::dot(d, right), glm::dot(d, up));
  }
}

// Which of several triangles a pixel keeps does not matter: at an outline all of them touch it.
void fill(Picture& picture, Index t, const dvec2& a, const dvec2& b, const dvec2& c) {
  forSpans(kSize, kSize, a, b, c, [&](int row, int from, int to) {
    for (int x = from; x < to; ++x) picture.triangle[static_cast<std::size_t>(row * kSize + x)] = t;
  });
}

// A point to the corners of every triangle at a covered pixel with an empty neighbour.
void count(const Picture& picture, const Surface& surface, std::vector<std::uint32_t>& counts) {
  const auto covered = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < kSize && y < kSize &&
           picture.triangle[static_cast<std::size_t>(y * kSize + x)] != kNone;
  };
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (!covered(x, y) ||
          (covered(x - 1, y) && covered(x + 1, y) && covered(x, y - 1) && covered(x, y + 1)))
        continue;
      const std::size_t t = picture.triangle[static_cast<std::size_t>(y * kSize + x)];
      for (std::size_t corner = 0; corner < 3; ++corner) ++counts[surface.corners[3 * t + corner]];
    }
}

std::vector<double> pointAreas(const Surface& surface) {
  std::vector<double> areas(surface.points.size(), 0.0);
  for (std::size_t k = 0; k < surface.corners.size(); ++k)
    areas[surface.corners[k]] += surface.areas[k / 3] / 3.0;
  return areas;
}

// Counts per area, spread over neighbours: a count is a rare event on a fine mesh.
std::vector<double> densities(const Surface& surface, const std::vector<std::uint32_t>& counts) {
  const std::vector<double> areas = pointAreas(surface);
  std::vector<double> amount(counts.begin(), counts.end()), density(counts.size(), 0.0);
  std::vector<double> sum(counts.size()), area(counts.size());
  for (int round = 0; round < kSmoothings; ++round) {
    std::fill(sum.begin(), sum.end(), 0.0);
    std::fill(area.begin(), area.end(), 0.0);
    for (std::size_t t = 0; t < surface.triangleCount(); ++t) {
      const Index* p = &surface.corners[3 * t];
      const double amounts = amount[p[0]] + amount[p[1]] + amount[p[2]];
      const double around = areas[p[0]] + areas[p[1]] + areas[p[2]];
      for (int corner = 0; corner < 3; ++corner) {
        sum[p[corner]] += amounts;
        area[p[corner]] += around;
      }
    }
    for (std::size_t i = 0; i < density.size(); ++i) {
      density[i] = area[i] > 0.0 ? sum[i] / area[i] : 0.0;
      amount[i] = density[i] * areas[i];
    }
  }
  return density;
}

}  // namespace

std::vector<double> outlineWeights(const Surface& surface, double floor, Workers& workers) {
  dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const dvec3& p : surface.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double radius = 0.5 * glm::length(high - low);
  const double scale = radius > 0.0 ? 0.49 * kSize / radius : 1.0;

  // Whole numbers: their sum does not depend on who counted what.
  std::vector<std::vector<std::uint32_t>> counts(static_cast<std::size_t>(workers.threads()));
  workers.forBlocks(kDirections, 1, [&](std::size_t k, std::size_t, int slot) {
    Picture picture;
    project(surface, direction(static_cast<int>(k)), 0.5 * (low + high), scale, picture.projected);
    std::fill(picture.triangle.begin(), picture.triangle.end(), kNone);
    for (Index t = 0; t < surface.triangleCount(); ++t)
      fill(picture, t, picture.projected[surface.corners[3 * t]],
           picture.projected[surface.corners[3 * t + 1]], picture.projected[surface.corners[3 * t + 2]]);
    std::vector<std::uint32_t>& own = counts[static_cast<std::size_t>(slot)];
    own.resize(surface.points.size());
    count(picture, surface, own);
  });
  std::vector<std::uint32_t> total(surface.points.size(), 0);
  for (const std::vector<std::uint32_t>& own : counts)
    for (std::size_t i = 0; i < own.size(); ++i) total[i] += own[i];

  std::vector<double> weights = densities(surface, total);
  double sum = 0.0, area = 0.0;
  const std::vector<double> areas = pointAreas(surface);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i] * areas[i];
    area += areas[i];
  }
  for (double& weight : weights) weight = (sum > 0.0 ? weight * area / sum : 1.0) + floor;
  return weights;
}

}  // namespace limn::coarsen
