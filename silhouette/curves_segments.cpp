// The silhouette segments of a refinement by silhouette curves: one across each triangle that the contour crosses, and the
// vertices that are lowered because they would hide a concave one.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III. Differs in: what
// contour.h and blocking.h say; where a model has fitted curves segments run on its patches (fitted_curves.h).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "silhouette/curves_pass.h"
#include "silhouette/step_counter.h"

namespace limn::silhouette {
namespace {

using glm::vec2;
using glm::vec3;

constexpr std::size_t kTrianglesPerBlock = 256;

// The patch above the straight line between the ends' weights: a cubic, known by its points at the thirds, where it adds
// (4 d_0 + 2 d_1)/9 and (2 d_0 + 4 d_1)/9 to the chord.
CurveOffsets curveOnPatch(const Patch& patch, const std::array<SegmentEnd, 2>& ends,
                          const std::array<vec2, 2>& weights) {
  std::array<vec3, 2> added;
  for (std::size_t k = 0; k < 2; ++k) {
    const float t = k == 0 ? 1.0f / 3.0f : 2.0f / 3.0f, s = 1.0f - t;
    const vec2 w = s * weights[0] + t * weights[1];
    added[k] = patch.point(1.0f - w.x - w.y, w.x, w.y) - (s * ends[0].place + t * ends[1].place);
  }
  return {3.0f * added[0] - 1.5f * added[1], 3.0f * added[1] - 1.5f * added[0]};
}

}  // namespace

void CurvesPass::findSegments() {
  const std::vector<std::uint32_t>& triangles = scratch.segmentTriangles;
  scratch.segments.resize(triangles.size());
  crew.forBlocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
    StepCounter steps(bound, parameters);
    for (std::size_t k = begin; k < end; ++k) {
      Segment& segment = scratch.segments[k];
      segment = segmentOf(triangles[k]);
      scratch.segmentOf[triangles[k]] = static_cast<std::uint32_t>(k);
      if (segment.exists)
        steps.add(segment.ends[0].place, segment.ends[1].place, segment.offsets, segment.steps);
    }
    reportCapped(steps.finish());
  });
}

CurvesPass::Segment CurvesPass::segmentOf(std::uint32_t triangle) const {
  const std::uint32_t* corner = &mesh.indices[3 * std::size_t{triangle}];
  const std::array<std::uint8_t, 3> seen{scratch.search.visible[corner[0]], scratch.search.visible[corner[1]],
                                         scratch.search.visible[corner[2]]};
  Segment segment;
  if (seen[0] == seen[1] && seen[1] == seen[2]) return segment;
  segment.lone = seen[1] == seen[2] ? 0 : seen[2] == seen[0] ? 1 : 2;
  const std::array<std::uint32_t, 2> sides{segment.lone, (segment.lone + 2) % 3};
  for (std::size_t end = 0; end < 2; ++end) {
    const SideView side = sideOf(triangle, sides[end]);
    if (side.edge == nullptr || !side.edge->crosses[side.face]) return segment;
    segment.ends[end] = scratch.search.points[side.edge->points][side.face].end;
    segment.weights[end] = sideWeights(sides[end], side.parameter());
  }
  segment.exists = true;
  segment.offsets = prepared.centers.empty()
                        ? segmentCurve(segment.ends[0], segment.ends[1], parameters.robust)
                        : curveOnPatch(fittedPatch(triangle), segment.ends, segment.weights);
  return segment;
}

Patch CurvesPass::fittedPatch(std::uint32_t triangle) const {
  Patch patch;
  for (std::size_t k = 0; k < 3; ++k) {
    patch.corners[k] = mesh.positions[mesh.indices[3 * std::size_t{triangle} + k]];
    const std::uint32_t e = topology.sideEdges()[3 * std::size_t{triangle} + k];
    if (e == kNone) continue;
    const Edge& edge = topology.edges()[e];
    const bool isSecond = edge.faces[1].triangle == triangle && edge.faces[1].side == k;
    const CurveOffsets& offsets = prepared.curves[e];
    patch.sides[k] = edge.runsBack(isSecond ? 1 : 0) ? CurveOffsets{offsets[1], offsets[0]} : offsets;
  }
  patch.fittedCenter = prepared.centers[triangle];
  return patch;
}

void CurvesPass::lowerPoints() {
  scratch.planes.clear();
  scratch.lowered.clear();
  for (std::size_t k = 0; k < scratch.segments.size(); ++k)
    if (scratch.segments[k].exists) addPlanes(scratch.segmentTriangles[k], scratch.segments[k]);
  std::vector<BlockingPlane>& planes = scratch.planes;
  std::sort(planes.begin(), planes.end(), [](const BlockingPlane& a, const BlockingPlane& b) {
    return a.point != b.point ? a.point < b.point : a.triangle < b.triangle;
  });
  for (std::size_t begin = 0, end = 0; begin < planes.size(); begin = end) {
    while (end < planes.size() && planes[end].point == planes[begin].point) ++end;
    const std::uint32_t point = planes[begin].point;
    const vec3 place = mesh.positions[mesh.indices[prepared.blocking.sidesFrom(point)[0]]];
    const vec3 displacement =
        prepared.blocking.displacement(place, std::span(planes).subspan(begin, end - begin));
    if (displacement != vec3(0.0f)) lower(point, displacement);
  }
}

// Every point of a concave segment's triangle feels its plane.
void CurvesPass::addPlanes(std::uint32_t triangle, const Segment& segment) {
  const SegmentEnd &first = segment.ends[0], &last = segment.ends[1];
  const float strength =
      std::min(first.trust, last.trust) * concavity(last.place - first.place, first.normal, last.normal);
  if (!(strength > 0.0f)) return;
  const vec3 normal = glm::normalize(first.normal + last.normal);
  const vec3 middle = curvePoint(first.place, last.place, segment.offsets, 0.5f);
  const vec2 w = 0.5f * (segment.weights[0] + segment.weights[1]);
  const std::array<float, 3> nearness{1.0f - w.x - w.y, w.x, w.y};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t point = topology.points()[mesh.indices[3 * std::size_t{triangle} + k]];
    const float weight = strength * Blocking::nearnessWeight(nearness[k]);
    if (weight > 0.0f && prepared.blocking.reach(point) > 0.0f)
      scratch.planes.push_back({point, triangle, weight, middle, normal});
  }
}

// Gives every vertex at a point one in the stream, and replaces its triangles.
void CurvesPass::lower(std::uint32_t point, const vec3& displacement) {
  for (const std::uint32_t side : prepared.blocking.sidesFrom(point)) {
    const std::uint32_t vertex = mesh.indices[side];
    markTriangle(stream.replaced, side / 3, crew.isAlone());
    if (scratch.loweredOf[vertex] != kNone) continue;
    const auto at = static_cast<std::uint32_t>(scratch.lowered.size());
    scratch.lowered.push_back(vertex);
    scratch.loweredOf[vertex] = at;
    stream.setCounts(at + 1, 0);
    const Origin origin{side / 3, {side % 3 == 1 ? 1.0f : 0.0f, side % 3 == 2 ? 1.0f : 0.0f}};
    writer.vertex(at, mesh.positions[vertex] + displacement, origin, kLinear);
  }
}

}  // namespace limn::silhouette
