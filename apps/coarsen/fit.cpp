// Based on: S. Marinov, L. Kobbelt, "Optimization methods for scattered data approximation with subdivision surfaces",
// 2005, for the alternation of closest points and linear least squares on distances to tangent planes; W. Wang, H.
// Pottmann, Y. Liu, "Fitting B-spline curves to point clouds by curvature-based squared distance minimization", 2006,
// for why plane distances converge fast.
// Differs in: points of the patches are paired with the surface and points of the surface with the patches, so that
// neither a far detail nor a wrinkle goes unnoticed; all is weighted by how much of the outline it makes; boundaries
// and creases are held on the surface's own by their distance from its lines.
#include "apps/coarsen/fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "apps/coarsen/normal_equations.h"

namespace limn::coarsen {
namespace {

using glm::dvec3;

constexpr int kGrid = 6;         // samples per side of a patch, plus one
constexpr int kLineSamples = 8;  // per curve of a boundary or crease
constexpr int kIterations = 40;  // of the linear solver
constexpr std::size_t kFewSamples = 20000;
constexpr std::size_t kManySamples = 60000;
constexpr std::size_t kPatchesPerBlock = 16;
constexpr std::size_t kSamplesPerBlock = 512;
// Relative to a squared distance along the surface's normal:
constexpr double kTangential = 0.05;  // one along it
constexpr double kLineWeight = 1.0;   // one from a boundary or crease
constexpr double kBending = 0.0005;   // a third difference of a boundary curve
constexpr double kCenterBending = 4 * kBending;
constexpr double kDamping = 0.02;      // a movement of a control point
constexpr double kLongestStep = 0.25;  // of the patch's size, in a round

/// A place on the surface that the patches should reach.
struct Sample {
  dvec3 point, normal;
  double weight;
};

double weightAt(const Surface& surface, const std::vector<double>& weights, std::size_t triangle,
                const std::array<double, 3>& at) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += at[k] * weights[surface.corners[3 * triangle + k]];
  return sum;
}

// The centroids of equal parts of the triangles: of few triangles many, of many every n-th.
std::vector<Sample> sampleSurface(const Surface& surface, const std::vector<double>& weights) {
  const std::size_t count = surface.triangleCount();
  const int parts = count == 0 ? 1
                               : std::max(1, static_cast<int>(std::sqrt(static_cast<double>(kFewSamples) /
                                                                        static_cast<double>(count))));
  const std::size_t stride = 1 + (count - 1) / kManySamples;
  std::vector<Sample> samples;
  for (std::size_t t = 0; t < count; t += stride)
    for (int row = 0; row < parts; ++row)
      for (int k = 0; k < 2 * (parts - row) - 1; ++k) {
        const double third = k % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
        const double v = (k / 2 + third) / parts, w = (row + third) / parts;
        const std::array<double, 3> at = {1.0 - v - w, v, w};
        samples.push_back({at[0] * surface.point(t, 0) + v * surface.point(t, 1) + w * surface.point(t, 2),
                           surface.normals[t],
                           surface.areas[t] * static_cast<double>(stride) / (parts * parts) *
                               weightAt(surface, weights, t, at)});
      }
  return samples;
}

// The weights of a patch's corners at t along a side.
std::array<double, 3> alongSide(int side, double t) {
  if (side == 0) return {1.0 - t, t, 0.0};
  if (side == 1) return {0.0, 1.0 - t, t};
  return {t, 0.0, 1.0 - t};
}

std::vector<Index> lineCorners(const Surface& surface) {
  std::vector<Index> corners;
  for (const std::array<Index, 2>& line : surface.lines)
    corners.insert(corners.end(), {line[0], line[1], line[1]});
  return corners;
}

class Fitter {
 public:
  Fitter(const Surface& surface, const std::vector<double>& weights, Workers& workers, PatchNet& net)
      : surface_(surface),
        weights_(weights),
        workers_(workers),
        net_(net),
        closest_(surface.points, surface.corners),
        lineCorners_(lineCorners(surface)),
        closestLine_(surface.points, lineCorners_),
        samples_(sampleSurface(surface, weights)),
        elements_(net.triangleCount()) {}

  void round(bool moveCorners) {
    for (Element& element : elements_) element.clear();
    pairPatches();
    pairSamples();
    pairLines();
    addBending();
    move(solve(net_, elements_, damping(), fixed(moveCorners), kIterations, workers_));
  }

 private:
  // Points of the patches with the closest of the surface.
  void pairPatches() {
    constexpr int kPoints = (kGrid + 1) * (kGrid + 2) / 2;
    workers_.forBlocks(elements_.size(), kPatchesPerBlock, [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t t = begin; t < end; ++t)
        for (int i = 0; i <= kGrid; ++i)
          for (int j = 0; j <= i; ++j) {
            const double u = 1.0 - static_cast<double>(i) / kGrid, w = static_cast<double>(j) / kGrid,
                         v = 1.0 - u - w;
            const PerControl<double> basis = bernstein(u, v, w);
            const dvec3 point = net_.evaluate(t, basis);
            const std::optional<Touch> touch = closest_.find(point, net_.normal(t, u, v, w));
            if (!touch) continue;
            const double weight =
                net_.flatArea(t) / kPoints * weightAt(surface_, weights_, touch->triangle, touch->weights);
            elements_[t].add(basis, point - touch->point, surface_.normals[touch->triangle], weight,
                             kTangential * weight);
          }
    });
  }

  // Samples of the surface with the closest points of the patches.
  void pairSamples() {
    const Tessellation patches = tessellate(net_, kGrid);
    const ClosestPoint closest(patches.points, patches.corners);
    std::vector<std::optional<Touch>> touches(samples_.size());
    workers_.forBlocks(samples_.size(), kSamplesPerBlock, [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t s = begin; s < end; ++s)
        touches[s] = closest.find(samples_[s].point, samples_[s].normal);
    });
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      if (!touches[s]) continue;
      std::array<double, 3> at{};
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t k = 0; k < 3; ++k)
          at[k] += touches[s]->weights[corner] *
                   patches.weights[patches.corners[3 * touches[s]->triangle + corner]][k];
      const std::size_t t = patches.patchOf(touches[s]->triangle);
      const PerControl<double> basis = bernstein(at[0], at[1], at[2]);
      elements_[t].add(basis, net_.evaluate(t, basis) - samples_[s].point, samples_[s].normal,
                       samples_[s].weight, kTangential * samples_[s].weight);
    }
  }

  // Points of boundary and crease curves with the closest of the surface's boundaries and creases.
  void pairLines() {
    for (const NetLine& line : net_.lines())
      for (int k = 0; k <= kLineSamples; ++k) {
        const std::array<double, 3> at = alongSide(line.side, static_cast<double>(k) / kLineSamples);
        const PerControl<double> basis = bernstein(at[0], at[1], at[2]);
        const dvec3 point = net_.evaluate(line.triangle, basis);
        const std::optional<Touch> touch = closestLine_.find(point);
        if (!touch) return;
        const std::array<Index, 2>& segment = surface_.lines[touch->triangle];
        const dvec3 along = surface_.points[segment[1]] - surface_.points[segment[0]];
        const double length = glm::length(along);
        if (!(length > 0.0)) continue;
        const double weight = kLineWeight * net_.flatArea(line.triangle) / kLineSamples;
        elements_[line.triangle].addAcross(basis, point - touch->point, along / length, weight);
      }
  }

  // Curves like an even spacing of their control points, patches the centre that their sides suggest.
  void addBending() {
    static constexpr std::array<std::array<std::size_t, 4>, 3> kSides = {
        {{0, 3, 4, 1}, {1, 5, 6, 2}, {2, 7, 8, 0}}};
    for (std::size_t t = 0; t < elements_.size(); ++t) {
      const PerControl<Index> id = net_.controlsOf(t);
      const auto add = [&](const PerControl<double>& row, double weight) {
        dvec3 residual(0.0);
        for (std::size_t i = 0; i < kControls; ++i) residual += row[i] * net_.controls[id[i]];
        elements_[t].add(row, residual, dvec3(0.0), 0.0, weight * net_.flatArea(t));
      };
      for (const std::array<std::size_t, 4>& side : kSides) {
        PerControl<double> row{};
        row[side[0]] = -1.0, row[side[1]] = 3.0, row[side[2]] = -3.0, row[side[3]] = 1.0;
        add(row, kBending);
      }
      constexpr double kSixth = 1.0 / 6.0;
      add({-kSixth, -kSixth, -kSixth, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, -1.0}, kCenterBending);
    }
  }

  std::vector<double> damping() const {
    std::vector<double> values(net_.controls.size(), 0.0);
    for (std::size_t t = 0; t < elements_.size(); ++t)
      for (const Index id : net_.controlsOf(t)) values[id] += kDamping * net_.flatArea(t);
    // A patch without area still needs equations that can be solved.
    for (double& value : values) value = std::max(value, 1e-30);
    return values;
  }

  std::vector<bool> fixed(bool moveCorners) const {
    std::vector<bool> flags(net_.controls.size(), false);
    if (!moveCorners) std::fill_n(flags.begin(), net_.pointCount(), true);
    return flags;
  }

  // No control point moves farther than a part of the smallest patch it belongs to.
  void move(const std::vector<dvec3>& steps) {
    std::vector<double> limits(steps.size(), std::numeric_limits<double>::infinity());
    for (std::size_t t = 0; t < elements_.size(); ++t) {
      const double limit = kLongestStep * std::sqrt(2.0 * net_.flatArea(t));
      for (const Index id : net_.controlsOf(t)) limits[id] = std::min(limits[id], limit);
    }
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double length = glm::length(steps[i]);
      net_.controls[i] += length > limits[i] ? steps[i] * (limits[i] / length) : steps[i];
    }
  }

  const Surface& surface_;
  const std::vector<double>& weights_;
  Workers& workers_;
  PatchNet& net_;
  ClosestPoint closest_;
  std::vector<Index> lineCorners_;
  ClosestPoint closestLine_;
  std::vector<Sample> samples_;
  std::vector<Element> elements_;
};

}  // namespace

void fitPatches(const Surface& surface, const std::vector<double>& weights, const FitSettings& settings,
                Workers& workers, PatchNet& net, const std::function<void(int)>& progress) {
  Fitter fitter(surface, weights, workers, net);
  for (int round = 0; round < settings.rounds; ++round) {
    fitter.round(settings.moveCorners);
    if (progress) progress(round + 1);
  }
}

}  // namespace limn::coarsen
