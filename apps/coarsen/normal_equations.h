// Sparse normal equations whose unknowns are 3D control points, ten to an element.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/coarsen/patch_net.h"
#include "raster/base/workers.h"

namespace limn::coarsen {

/// One patch's part of AᵀA x = -Aᵀr.
class Element {
 public:
  void clear();
  /// Adds w ⟨n, Σ basis_i x_i + r⟩² + wAll |Σ basis_i x_i + r|² with `r` the residual at x = 0.
  void add(const PerControl<double>& basis, const glm::dvec3& residual, const glm::dvec3& n, double w,
           double wAll);
  /// Adds w (|y|² - ⟨t, y⟩²), y = Σ basis_i x_i + r: the distance from a line along the unit vector t.
  void addAcross(const PerControl<double>& basis, const glm::dvec3& residual, const glm::dvec3& t, double w) {
    add(basis, residual, t, -w, w);
  }

  /// out_i = Σ_j A_ij x_j.
  void apply(const PerControl<glm::dvec3>& x, PerControl<glm::dvec3>& out) const;
  glm::dmat3 diagonal(std::size_t i) const { return block(i, i); }
  const PerControl<glm::dvec3>& gradient() const { return gradient_; }

 private:
  // Symmetric 3 by 3 blocks of the lower triangle: xx xy xz yy yz zz.
  using Block = std::array<double, 6>;
  static std::size_t slot(std::size_t i, std::size_t j) { return i * (i + 1) / 2 + j; }
  glm::dmat3 block(std::size_t i, std::size_t j) const;

  std::array<Block, kControls*(kControls + 1) / 2> blocks_{};
  PerControl<glm::dvec3> gradient_{};
};

/// Solves (Σ elements + diag(damping)) x = -Σ gradients by preconditioned conjugate gradients; unknowns whose `fixed` is
/// set stay 0. Every sum has one order, whatever the number of threads.
std::vector<glm::dvec3> solve(const PatchNet& net, const std::vector<Element>& elements,
                              const std::vector<double>& damping, const std::vector<bool>& fixed,
                              int iterations, Workers& workers);

}  // namespace limn::coarsen
