// The control points of cubic Bézier triangles that cover a coarse mesh and share their boundary curves.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "apps/coarsen/surface.h"

namespace limn::coarsen {

/// The control points of one patch, in the order b300 b030 b003 b210 b120 b021 b012 b102 b201 b111.
inline constexpr std::size_t kControls = 10;
template <class T>
using PerControl = std::array<T, kControls>;

/// Bernstein polynomials at the weights u, v, w of corners 0, 1, 2.
PerControl<double> bernstein(double u, double v, double w);

/// A side of a patch as part of a boundary or crease.
struct NetLine {
  Index triangle = 0;
  int side = 0;  ///< from corner `side` to the next
};

class PatchNet {
 public:
  /// Straight patches over welded triangles. `lines`: pairs of points that a boundary or crease joins.
  PatchNet(std::vector<glm::dvec3> points, std::vector<Index> corners,
           std::span<const std::array<Index, 2>> lines);

  std::size_t triangleCount() const { return corners_.size() / 3; }
  std::size_t pointCount() const { return pointCount_; }
  std::size_t edgeCount() const { return edges_.size(); }
  const std::vector<Index>& corners() const { return corners_; }
  const std::vector<NetLine>& lines() const { return lines_; }
  Index edgeOf(std::size_t triangle, int side) const {
    return sideEdges_[3 * triangle + static_cast<std::size_t>(side)];
  }

  /// Where each control point is in `controls`: first the points, then two per edge, then one per triangle.
  PerControl<Index> controlsOf(std::size_t triangle) const;
  Index endControl(Index edge, Index from) const {
    return static_cast<Index>(pointCount_) + 2 * edge + (edges_[edge][0] == from ? 0 : 1);
  }
  Index centerControl(std::size_t triangle) const {
    return static_cast<Index>(pointCount_ + 2 * edges_.size() + triangle);
  }

  glm::dvec3 evaluate(std::size_t triangle, const PerControl<double>& basis) const;
  /// Normal of the patch, not unit.
  glm::dvec3 normal(std::size_t triangle, double u, double v, double w) const;
  double flatArea(std::size_t triangle) const;

  /// b111 that the six others of a patch suggest (Vlachos et al. 2001).
  glm::dvec3 defaultCenter(std::size_t triangle) const;
  void straighten(Index edge);

  std::vector<glm::dvec3> controls;

 private:
  std::size_t pointCount_ = 0;
  std::vector<Index> corners_;
  std::vector<std::array<Index, 2>> edges_;  // the lower point first
  std::vector<Index> sideEdges_;
  std::vector<NetLine> lines_;
};

/// The patches as triangles, `segments` per side: every patch has points and triangles of its own, in order.
struct Tessellation {
  std::vector<glm::dvec3> points;
  std::vector<std::array<double, 3>> weights;  ///< of the points, in their patch
  std::vector<Index> corners;
  int segments = 0;

  std::size_t patchOf(std::size_t triangle) const {
    return triangle / static_cast<std::size_t>(segments * segments);
  }
};
Tessellation tessellate(const PatchNet& net, int segments);

}  // namespace limn::coarsen
