#include "silhouette/edge_search.h"

#include "silhouette/chord_kernel.h"
#include "silhouette/collect.h"
#include "silhouette/crossing_kernel.h"
#include "silhouette/facing_kernel.h"
#include "silhouette/view_scale.h"

namespace limn::silhouette {
namespace {

constexpr std::size_t kItemsPerBlock = 4096;
constexpr float kUnseen = 0.25f;  // share of the tolerance

// Silhouette points by batches.
class PointFinder {
 public:
  PointFinder(const Mesh& mesh, const CurveSet& curves, const View& view)
      : mesh_(mesh), curves_(curves), view_(view) {}

  /// Sets the point of a face, and without a seam that of both, at the latest in finish(); until then it must not move.
  void add(std::uint32_t e, std::size_t face, SilhouettePoints& points) {
    const std::array<std::uint32_t, 2>& v = curves_.vertices[e][face];
    const CurveOffsets& d = curves_.curves[e];
    wanted_[batch_.count] = {e, face, &points};
    batch_.add(mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.normals[v[0]], mesh_.normals[v[1]], d[0],
               d[1]);
    if (batch_.count == CrossedBatch::kCapacity) find();
  }
  void finish() { find(); }

 private:
  struct Wanted {
    std::uint32_t edge;
    std::size_t face;
    SilhouettePoints* points;
  };

  void find() {
    computeCrossings(view_, batch_, crossings_);
    for (std::size_t i = 0; i < batch_.count; ++i) {
      const auto& [e, face, points] = wanted_[i];
      const float t = crossings_.parameters[i];
      // Where the normals of the ends cancel, the face's counts.
      const glm::vec3 unit = crossings_.squares[i] > 1e-12f
                                 ? crossings_.unit(i)
                                 : curves_.faceNormals[curves_.links[e].faces[face]];
      (*points)[face] = {true, t, crossings_.normal(i), {crossings_.place(i), unit, curves_.trust[e].at(t)}};
      if (!curves_.links[e].seam) (*points)[1] = (*points)[0];
    }
    batch_.count = 0;
  }

  const Mesh& mesh_;
  const CurveSet& curves_;
  const View& view_;
  CrossedBatch batch_{};
  Crossings crossings_;
  std::array<Wanted, CrossedBatch::kCapacity> wanted_;
};

}  // namespace

void EdgeSearch::run(const Mesh& mesh, const Topology& topology, const CurveSet& curves, const View& view,
                     const Parameters& parameters, const Crew& crew) {
  const std::size_t edges = curves.links.size();
  heights.resize(mesh.positions.size());
  visible.resize(mesh.positions.size());
  planeHeights.resize(mesh.triangleCount());
  states.resize(edges);
  pointsOf.resize(edges);
  // What bends less nobody sees.
  const float scale = ViewScale(view).within(curves.middle, curves.radius);
  const float leastBend = parameters.segments > 0 ? 0.0f : kUnseen * parameters.tolerance / scale;
  findVisible(curves, view, curves.largestBend > leastBend, crew);

  const RingTest ring{mesh, topology, curves, view, visible, heights, points, pointsOf};
  const Limits limits{leastBend, ring.largestProduct()};
  findCandidates(curves, view, limits, crew);
  findPoints(mesh, curves, view, crew);
  alphas.resize(candidates.size());
  const PixelBound bound(view);
  crew.forBlocks(candidates.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    findAlphas(begin, end, ring, bound, parameters);
  });
}

void EdgeSearch::findVisible(const CurveSet& curves, const View& view, bool mayBend, const Crew& crew) {
  const bool perspective = view.projection.perspective;
  const glm::vec3 eye = perspective ? view.eye : -view.direction;
  crew.forBlocks(heights.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    computeHeights(eye, perspective, curves.corners.arrays().from(begin), end - begin, &heights[begin]);
    for (std::size_t v = begin; v < end; ++v) visible[v] = heights[v] >= 0.0f ? 1 : 0;
  });
  if (!mayBend) return;
  crew.forBlocks(planeHeights.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    computeHeights(eye, perspective, curves.planes.arrays().from(begin), end - begin, &planeHeights[begin]);
  });
}

void EdgeSearch::findCandidates(const CurveSet& curves, const View& view, const Limits& limits,
                                const Crew& crew) {
  constexpr std::size_t kRunsPerBlock = kItemsPerBlock / EdgeRun::kEdges;
  candidatesOfRun.resize(curves.runs.size());
  crew.forBlocks(curves.runs.size(), kRunsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) candidatesOfRun[r] = lookInto(r, curves, view, limits);
  });
  collect(
      crew, curves.runs.size(), blockCounts, candidates,
      [&](std::size_t r) { return std::uint32_t{candidatesOfRun[r]}; },
      [&](std::size_t r, std::uint32_t at) {
        for (std::size_t e = curves.firstOfRun(r); e < curves.firstOfRun(r + 1); ++e)
          if (states[e] != 0) candidates[at++] = static_cast<std::uint32_t>(e);
      });
}

// Sets the states of a run's edges and returns how many may matter. Runs that clearly face one way are passed over: nothing
// crosses them, and what bends visibly stands out at the contour only.
std::uint8_t EdgeSearch::lookInto(std::size_t r, const CurveSet& curves, const View& view,
                                  const Limits& limits) {
  const EdgeRun& run = curves.runs[r];
  const float least = run.always ? 0.0f : run.cone.facings(view).least;
  if (least > 0.0f && (run.bend <= limits.leastBend || least * least > RingTest::kBeta)) return 0;
  std::uint8_t count = 0;
  for (std::size_t e = curves.firstOfRun(r); e < curves.firstOfRun(r + 1); ++e) {
    states[e] = stateOf(e, curves, limits);
    if (states[e] != 0) ++count;
  }
  return count;
}

// Whether silhouette curves cross the edge, and whether it may show its curve.
std::uint8_t EdgeSearch::stateOf(std::size_t e, const CurveSet& curves, const Limits& limits) const {
  const EdgeLink& link = curves.links[e];
  const bool bends = link.bend > limits.leastBend &&
                     planeHeights[link.faces[0]] * planeHeights[link.faces[1]] < limits.largestProduct;
  bool differs = visible[link.ends[0]] != visible[link.ends[1]];
  if (link.seam) {
    const std::array<std::uint32_t, 2>& second = curves.vertices[e][1];
    differs = differs || visible[second[0]] != visible[second[1]];
  }
  const unsigned mayBend = (link.always ? 1U : 0U) | (bends ? 1U : 0U);
  const unsigned isCut = (differs ? 1U : 0U) & (link.bridged ? 1U : 0U);
  return static_cast<std::uint8_t>(isCut * kCrossed + mayBend * kMayBend);
}

void EdgeSearch::findPoints(const Mesh& mesh, const CurveSet& curves, const View& view, const Crew& crew) {
  collect(
      crew, candidates.size(), blockCounts, crossed,
      [&](std::size_t k) { return isCrossed(candidates[k]) ? 1U : 0U; },
      [&](std::size_t k, std::uint32_t at) { crossed[at] = candidates[k]; });
  points.resize(crossed.size());
  crew.forBlocks(crossed.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    PointFinder finder(mesh, curves, view);
    for (std::size_t at = begin; at < end; ++at) {
      const std::uint32_t e = crossed[at];
      const EdgeVertices& v = curves.vertices[e];
      pointsOf[e] = static_cast<std::uint32_t>(at);
      points[at] = {};
      if (!curves.links[e].seam) {
        finder.add(e, 0, points[at]);
        continue;
      }
      for (std::size_t face = 0; face < 2; ++face)
        if (visible[v[face][0]] != visible[v[face][1]]) finder.add(e, face, points[at]);
    }
    finder.finish();
  });
}

// Of candidates begin … end - 1. Curves that nobody sees are told by batches before anything around them is looked at: on a
// fine mesh that is nearly every edge by the contour.
void EdgeSearch::findAlphas(std::size_t begin, std::size_t end, const RingTest& ring, const PixelBound& bound,
                            const Parameters& parameters) {
  CurveBatch batch{};
  std::array<std::size_t, CurveBatch::kCapacity> places;
  const auto lookAround = [&] {
    CurveErrors errors{};
    if (parameters.segments == 0) curveErrors(bound, batch, errors);
    for (std::size_t i = 0; i < batch.count; ++i) {
      float& alpha = alphas[places[i]];
      const bool isSeen = parameters.segments > 0 || errors.bends[i] > kUnseen * parameters.tolerance;
      alpha = isSeen ? ring.alpha(candidates[places[i]], alpha) : 0.0f;
    }
    batch.count = 0;
  };
  for (std::size_t k = begin; k < end; ++k) {
    const std::uint32_t e = candidates[k];
    const EdgeLink& link = ring.curves.links[e];
    alphas[k] = link.always ? 1.0f : 0.0f;
    if (link.always || (states[e] & kMayBend) == 0) continue;
    alphas[k] = ring.silhouetteness(e);
    if (alphas[k] == 0.0f) continue;
    places[batch.count] = k;
    const CurveOffsets& d = ring.curves.curves[e];
    batch.add(ring.mesh.positions[link.ends[0]], ring.mesh.positions[link.ends[1]], d[0], d[1]);
    if (batch.count == CurveBatch::kCapacity) lookAround();
  }
  lookAround();
}

}  // namespace limn::silhouette
