// Which edges of a mesh matter in a view: one pass over vertices, triangles and runs of edges.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III.B. Differs in: the
// hierarchy has one level, runs of 64 edges in the order of the mesh, which in practice are neighbours; signs of vertices and
// of the eye's distances from the triangles' planes come a vector at a time (facing_kernel.h), after which an edge takes two
// comparisons, and only those that a silhouette curve crosses or that the flat outline follows take more.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "silhouette/curve_set.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/ring.h"

namespace limn::silhouette {

struct EdgeSearch {
  std::vector<float> heights;         ///< per vertex of the mesh: contour.h, facing()
  std::vector<std::uint8_t> visible;  ///< likewise
  std::vector<float>
      planeHeights;  ///< per triangle: the eye's distance from its plane, where curves may be seen
  std::vector<std::uint8_t> states;           ///< per edge of the runs that were looked into
  std::vector<std::uint8_t> candidatesOfRun;  ///< per EdgeRun: how many of its edges may matter
  std::vector<std::uint32_t> candidates;      ///< edges that may matter, ascending
  std::vector<float> alphas;                  ///< of each: the share of its curve that is shown
  std::vector<std::uint32_t> crossed;         ///< those that silhouette curves cross
  std::vector<SilhouettePoints> points;       ///< where, of each
  std::vector<std::uint32_t> pointsOf;        ///< per edge that is crossed: index into points
  std::vector<std::uint32_t> blockCounts;     ///< scratch memory of collect()

  /// Curves that stay within a quarter of the tolerance of their chords count as straight; not so with fixed segments.
  void run(const Mesh& mesh, const Topology& topology, const CurveSet& curves, const View& view,
           const Parameters& parameters, const Crew& crew);

  /// Whether candidate `k` has silhouette points or shows its curve.
  bool isListed(std::size_t k) const { return alphas[k] > 0.0f || isCrossed(candidates[k]); }

  /// Whether candidate `e` has silhouette points, in one of its faces at least.
  bool isCrossed(std::size_t e) const { return (states[e] & kCrossed) != 0; }

 private:
  enum State : std::uint8_t { kCrossed = 1, kMayBend = 2 };

  /// Of edges that may show their curves: in model units, and of the eye's distances from the planes of their faces.
  struct Limits {
    float leastBend, largestProduct;
  };

  void findCandidates(const CurveSet& curves, const View& view, const Limits& limits, const Crew& crew);
  std::uint8_t lookInto(std::size_t r, const CurveSet& curves, const View& view, const Limits& limits);
  void findVisible(const CurveSet& curves, const View& view, bool mayBend, const Crew& crew);
  std::uint8_t stateOf(std::size_t e, const CurveSet& curves, const Limits& limits) const;
  void findPoints(const Mesh& mesh, const CurveSet& curves, const View& view, const Crew& crew);
  void findAlphas(std::size_t begin, std::size_t end, const RingTest& ring, const PixelBound& bound,
                  const Parameters& parameters);
};

}  // namespace limn::silhouette
