#include "apps/coarsen/patch_net.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "apps/coarsen/normal_equations.h"

namespace limn::coarsen {
namespace {

using glm::dvec3;

// Two triangles that share an edge.
PatchNet pair() {
  return PatchNet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}, {});
}

double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / 4294967296.0 - 0.5;
}

void shake(PatchNet& net, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (dvec3& control : net.controls)
    for (int k = 0; k < 3; ++k) control[k] += 0.3 * uniform(random);
}

TEST(PatchNet, BernsteinSumsToOne) {
  const PerControl<double> basis = bernstein(0.2, 0.5, 0.3);
  EXPECT_NEAR(std::accumulate(basis.begin(), basis.end(), 0.0), 1.0, 1e-15);
}

TEST(PatchNet, StraightPatchesAreTheirTriangles) {
  const PatchNet net = pair();
  EXPECT_EQ(net.edgeCount(), 5u);
  const dvec3 point = net.evaluate(1, bernstein(0.25, 0.25, 0.5));
  EXPECT_LT(glm::distance(point, dvec3(0.25, 0.75, 0)), 1e-15);
}

TEST(PatchNet, NeighboursShareTheirCurve) {
  PatchNet net = pair();
  shake(net, 5);
  for (const double t : {0.1, 0.5, 0.8}) {
    const dvec3 first = net.evaluate(0, bernstein(1 - t, 0, t));  // side from point 0 to point 2
    const dvec3 second = net.evaluate(1, bernstein(1 - t, t, 0));
    EXPECT_LT(glm::distance(first, second), 1e-15);
  }
}

TEST(PatchNet, NormalIsTheCrossProductOfDifferences) {
  PatchNet net = pair();
  shake(net, 6);
  const double u = 0.3, v = 0.45, w = 0.25, h = 1e-6;
  const dvec3 here = net.evaluate(0, bernstein(u, v, w));
  const dvec3 alongV = (net.evaluate(0, bernstein(u - h, v + h, w)) - here) / h;
  const dvec3 alongW = (net.evaluate(0, bernstein(u - h, v, w + h)) - here) / h;
  const dvec3 expected = glm::normalize(glm::cross(alongV, alongW));
  EXPECT_GT(glm::dot(glm::normalize(net.normal(0, u, v, w)), expected), 1.0 - 1e-9);
}

TEST(PatchNet, SolverFindsTheLeastSquares) {
  // Targets for enough points of both patches, in all directions, that the control points follow from them.
  PatchNet wanted = pair();
  shake(wanted, 7);
  PatchNet net = pair();
  std::vector<Element> elements(2);
  for (std::size_t t = 0; t < 2; ++t)
    for (int i = 0; i <= 5; ++i)
      for (int j = 0; j <= i; ++j) {
        const double u = 1 - i / 5.0, w = j / 5.0;
        const PerControl<double> basis = bernstein(u, 1 - u - w, w);
        elements[t].add(basis, net.evaluate(t, basis) - wanted.evaluate(t, basis), dvec3(0, 0, 1), 1.0, 0.5);
      }
  Workers workers(2);
  const std::vector<dvec3> steps = solve(net, elements, std::vector<double>(net.controls.size(), 0.0),
                                         std::vector<bool>(net.controls.size(), false), 400, workers);
  for (std::size_t i = 0; i < steps.size(); ++i)
    EXPECT_LT(glm::distance(net.controls[i] + steps[i], wanted.controls[i]), 1e-3) << i;
}

}  // namespace
}  // namespace limn::coarsen
