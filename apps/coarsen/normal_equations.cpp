// Based on: J. Nocedal, S. Wright, "Numerical Optimization", 2nd ed., 2006, algorithm 5.3, with the inverses of the
// diagonal 3 by 3 blocks as preconditioner.
#include "apps/coarsen/normal_equations.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace limn::coarsen {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr std::size_t kPatchesPerBlock = 64;
constexpr double kEnough = 1e-8;  // of the squared preconditioned residual

double dot(const std::vector<dvec3>& a, const std::vector<dvec3>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i], b[i]);
  return sum;
}

}  // namespace

void Element::clear() {
  blocks_ = {};
  gradient_ = {};
}

void Element::add(const PerControl<double>& basis, const dvec3& residual, const dvec3& n, double w,
                  double wAll) {
  const Block m = {w * n.x * n.x + wAll, w * n.x * n.y, w * n.x * n.z,
                   w * n.y * n.y + wAll, w * n.y * n.z, w * n.z * n.z + wAll};
  const dvec3 force = w * glm::dot(n, residual) * n + wAll * residual;
  for (std::size_t i = 0; i < kControls; ++i) {
    gradient_[i] += basis[i] * force;
    for (std::size_t j = 0; j <= i; ++j) {
      const double product = basis[i] * basis[j];
      Block& block = blocks_[slot(i, j)];
      for (std::size_t k = 0; k < m.size(); ++k) block[k] += product * m[k];
    }
  }
}

dmat3 Element::block(std::size_t i, std::size_t j) const {
  const Block& b = blocks_[i >= j ? slot(i, j) : slot(j, i)];
  return {b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5]};
}

void Element::apply(const PerControl<dvec3>& x, PerControl<dvec3>& out) const {
  const auto times = [](const Block& b, const dvec3& v) {
    return dvec3(b[0] * v.x + b[1] * v.y + b[2] * v.z, b[1] * v.x + b[3] * v.y + b[4] * v.z,
                 b[2] * v.x + b[4] * v.y + b[5] * v.z);
  };
  for (std::size_t i = 0; i < kControls; ++i) {
    out[i] = times(blocks_[slot(i, i)], x[i]);
    for (std::size_t j = 0; j < i; ++j) {
      out[i] += times(blocks_[slot(i, j)], x[j]);
      out[j] += times(blocks_[slot(i, j)], x[i]);
    }
  }
}

std::vector<dvec3> solve(const PatchNet& net, const std::vector<Element>& elements,
                         const std::vector<double>& damping, const std::vector<bool>& fixed, int iterations,
                         Workers& workers) {
  const std::size_t count = net.controls.size();
  std::vector<dvec3> x(count, dvec3(0.0)), residual(count, dvec3(0.0)), z(count), direction(count),
      image(count);
  std::vector<dmat3> preconditioner(count, dmat3(0.0));
  for (std::size_t t = 0; t < elements.size(); ++t) {
    const PerControl<Index> id = net.controlsOf(t);
    for (std::size_t i = 0; i < kControls; ++i) {
      residual[id[i]] -= elements[t].gradient()[i];
      preconditioner[id[i]] += elements[t].diagonal(i);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) preconditioner[i][k][k] += damping[i];
    preconditioner[i] = glm::inverse(preconditioner[i]);
    if (fixed[i]) residual[i] = dvec3(0.0);
    z[i] = preconditioner[i] * residual[i];
  }

  std::vector<PerControl<dvec3>> products(elements.size());
  direction = z;
  double energy = dot(residual, z);
  const double first = energy;
  for (int iteration = 0; iteration < iterations && energy > kEnough * first; ++iteration) {
    workers.forBlocks(elements.size(), kPatchesPerBlock, [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t t = begin; t < end; ++t) {
        const PerControl<Index> id = net.controlsOf(t);
        PerControl<dvec3> local;
        for (std::size_t i = 0; i < kControls; ++i) local[i] = direction[id[i]];
        elements[t].apply(local, products[t]);
      }
    });
    for (std::size_t i = 0; i < count; ++i) image[i] = damping[i] * direction[i];
    for (std::size_t t = 0; t < elements.size(); ++t) {
      const PerControl<Index> id = net.controlsOf(t);
      for (std::size_t i = 0; i < kControls; ++i) image[id[i]] += products[t][i];
    }
    for (std::size_t i = 0; i < count; ++i)
      if (fixed[i]) image[i] = dvec3(0.0);
    const double curvature = dot(direction, image);
    if (!(curvature > 0.0)) break;
    const double step = energy / curvature;
    for (std::size_t i = 0; i < count; ++i) {
      x[i] += step * direction[i];
      residual[i] -= step * image[i];
      z[i] = preconditioner[i] * residual[i];
    }
    const double next = dot(residual, z);
    for (std::size_t i = 0; i < count; ++i) direction[i] = z[i] + next / energy * direction[i];
    energy = next;
  }
  return x;
}

}  // namespace limn::coarsen
