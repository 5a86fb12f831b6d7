// Based on: A. Vlachos, J. Peters, C. Boyd, J. Mitchell, "Curved PN triangles", 2001, for the patch and its centre;
// G. Farin, "Curves and Surfaces for CAGD", 5th ed., 2002, section 17, for its derivatives.
#include "apps/coarsen/patch_net.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace limn::coarsen {

using glm::dvec3;

PerControl<double> bernstein(double u, double v, double w) {
  return {u * u * u,     v * v * v,     w * w * w,     3 * u * u * v, 3 * u * v * v,
          3 * v * v * w, 3 * v * w * w, 3 * w * w * u, 3 * w * u * u, 6 * u * v * w};
}

PatchNet::PatchNet(std::vector<dvec3> points, std::vector<Index> corners,
                   std::span<const std::array<Index, 2>> lines)
    : controls(std::move(points)), pointCount_(controls.size()), corners_(std::move(corners)) {
  struct SideKey {
    Index low, high, side;
    // The finding is in <compare>.
    auto operator<=>(const SideKey&) const = default;  // NOLINT(modernize-use-nullptr)
  };
  std::vector<SideKey> sides;
  for (Index side = 0; side < corners_.size(); ++side) {
    const Index a = corners_[side], b = corners_[side % 3 == 2 ? side - 2 : side + 1];
    sides.push_back({std::min(a, b), std::max(a, b), side});
  }
  std::sort(sides.begin(), sides.end());
  sideEdges_.resize(corners_.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (k == 0 || sides[k].low != sides[k - 1].low || sides[k].high != sides[k - 1].high)
      edges_.push_back({sides[k].low, sides[k].high});
    sideEdges_[sides[k].side] = static_cast<Index>(edges_.size() - 1);
  }
  for (const std::array<Index, 2>& line : lines) {
    const SideKey key{std::min(line[0], line[1]), std::max(line[0], line[1]), 0};
    const auto found = std::lower_bound(sides.begin(), sides.end(), key);
    if (found != sides.end() && found->low == key.low && found->high == key.high)
      lines_.push_back({found->side / 3, static_cast<int>(found->side % 3)});
  }
  controls.resize(pointCount_ + 2 * edges_.size() + triangleCount());
  for (Index e = 0; e < edges_.size(); ++e) straighten(e);
  for (std::size_t t = 0; t < triangleCount(); ++t) controls[centerControl(t)] = defaultCenter(t);
}

void PatchNet::straighten(Index edge) {
  const dvec3 &a = controls[edges_[edge][0]], &b = controls[edges_[edge][1]];
  controls[pointCount_ + 2 * edge] = (2.0 * a + b) / 3.0;
  controls[pointCount_ + 2 * edge + 1] = (a + 2.0 * b) / 3.0;
}

PerControl<Index> PatchNet::controlsOf(std::size_t triangle) const {
  const Index *p = &corners_[3 * triangle], *e = &sideEdges_[3 * triangle];
  return {p[0],
          p[1],
          p[2],
          endControl(e[0], p[0]),
          endControl(e[0], p[1]),
          endControl(e[1], p[1]),
          endControl(e[1], p[2]),
          endControl(e[2], p[2]),
          endControl(e[2], p[0]),
          centerControl(triangle)};
}

dvec3 PatchNet::evaluate(std::size_t triangle, const PerControl<double>& basis) const {
  const PerControl<Index> id = controlsOf(triangle);
  dvec3 sum(0.0);
  for (std::size_t i = 0; i < kControls; ++i) sum += basis[i] * controls[id[i]];
  return sum;
}

dvec3 PatchNet::normal(std::size_t triangle, double u, double v, double w) const {
  const PerControl<Index> id = controlsOf(triangle);
  const auto c = [&](std::size_t i) { return controls[id[i]]; };
  const dvec3 du =
      u * u * c(0) + v * v * c(4) + w * w * c(7) + 2.0 * (u * v * c(3) + u * w * c(8) + v * w * c(9));
  const dvec3 dv =
      v * v * c(1) + u * u * c(3) + w * w * c(6) + 2.0 * (u * v * c(4) + v * w * c(5) + u * w * c(9));
  const dvec3 dw =
      w * w * c(2) + v * v * c(5) + u * u * c(8) + 2.0 * (v * w * c(6) + u * w * c(7) + u * v * c(9));
  return glm::cross(dv - du, dw - du);
}

double PatchNet::flatArea(std::size_t triangle) const {
  const Index* p = &corners_[3 * triangle];
  return 0.5 * glm::length(glm::cross(controls[p[1]] - controls[p[0]], controls[p[2]] - controls[p[0]]));
}

dvec3 PatchNet::defaultCenter(std::size_t triangle) const {
  const PerControl<Index> id = controlsOf(triangle);
  dvec3 ends(0.0), corners(0.0);
  for (std::size_t i = 0; i < 3; ++i) corners += controls[id[i]];
  for (std::size_t i = 3; i < 9; ++i) ends += controls[id[i]];
  return ends / 4.0 - corners / 6.0;
}

Tessellation tessellate(const PatchNet& net, int segments) {
  Tessellation out;
  out.segments = segments;
  std::vector<std::array<double, 3>> weights;
  std::vector<PerControl<double>> bases;
  for (int i = 0; i <= segments; ++i)
    for (int j = 0; j <= i; ++j) {
      const double u = 1.0 - static_cast<double>(i) / segments, w = static_cast<double>(j) / segments;
      weights.push_back({u, 1.0 - u - w, w});
      bases.push_back(bernstein(u, 1.0 - u - w, w));
    }
  for (std::size_t t = 0; t < net.triangleCount(); ++t) {
    const auto base = static_cast<Index>(out.points.size());
    for (const PerControl<double>& basis : bases) out.points.push_back(net.evaluate(t, basis));
    out.weights.insert(out.weights.end(), weights.begin(), weights.end());
    const auto at = [&](int i, int j) { return base + static_cast<Index>(i * (i + 1) / 2 + j); };
    for (int i = 0; i < segments; ++i)
      for (int j = 0; j <= i; ++j) {
        out.corners.insert(out.corners.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        if (j < i) out.corners.insert(out.corners.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return out;
}

}  // namespace limn::coarsen
