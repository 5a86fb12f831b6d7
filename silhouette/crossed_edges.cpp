#include "silhouette/crossed_edges.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace limn::silhouette {
namespace {

float sampleParameter(std::uint32_t sample, std::uint32_t segments) {
  return static_cast<float>(sample) / static_cast<float>(segments);
}

// The sample of the polyline, ends included, that is nearest to t.
std::uint32_t nearestSample(float t, std::uint32_t segments) {
  return static_cast<std::uint32_t>(std::floor(t * static_cast<float>(segments) + 0.5f));
}

// The parameter of the silhouette point, after it has become a vertex near it if there is one.
float settled(float t, bool& own, const CrossedEdge& edge, const ShownCurve& shown,
              const std::array<bool, 2>& open, const PixelBound& bound, float snap) {
  own = true;
  const glm::vec2 seen = bound.place(shown.bridge.point(t));
  const auto isThere = [&](const glm::vec3& vertex) {
    return glm::length(seen - bound.place(vertex)) <= snap;
  };
  for (std::size_t end = 0; end < 2; ++end) {
    if (!open[end]) continue;
    const auto there = static_cast<float>(end);
    own = own && t != there && !isThere(shown.bridge.ends[end]);
    if (!own) return there;
  }
  const std::uint32_t sample = nearestSample(t, edge.segments);
  if (sample == 0 || sample == edge.segments) return t;
  const float there = sampleParameter(sample, edge.segments);
  own = t != there && !isThere(shown.sample(sample, edge.segments));
  return own ? t : there;
}

}  // namespace

glm::vec3 ShownCurve::sample(std::uint32_t k, std::uint32_t segments) const {
  const std::array<glm::vec3, 2>& ends = bridge.ends;
  if (peak <= 0.0f || peak >= 1.0f || alpha == 1.0f)
    return EdgeCurve{ends, {alpha * bridge.offsets[0], alpha * bridge.offsets[1]}}.sample(k, segments);
  const float t = sampleParameter(k, segments);
  const glm::vec3 top = bridge.point(peak);
  const bool isBefore = t < peak;
  const float s = isBefore ? t / peak : (1.0f - t) / (1.0f - peak);
  const glm::vec3 straight = s * top + (1.0f - s) * ends[isBefore ? 0 : 1];
  return straight + alpha * (bridge.sample(k, segments) - straight);
}

void settle(CrossedEdge& edge, const ShownCurve& shown, const std::array<bool, 2>& open,
            const PixelBound& bound, float snap) {
  for (std::size_t face = 0; face < 2; ++face) {
    if (!edge.crosses[face]) continue;
    if (face == 1 && edge.crosses[0] && edge.parameter[1] == edge.parameter[0] && edge.own[0]) {
      edge.own[1] = false;  // the same point
      continue;
    }
    edge.parameter[face] = settled(edge.parameter[face], edge.own[face], edge, shown, open, bound, snap);
  }
  if (edge.own[0] && edge.own[1]) {
    const auto seen = [&](std::size_t face) { return bound.place(shown.bridge.point(edge.parameter[face])); };
    if (glm::length(seen(1) - seen(0)) <= snap) {
      edge.parameter[1] = edge.parameter[0];
      edge.own[1] = false;
    }
  }

  EdgeVertexList list;
  edge.count = static_cast<std::uint32_t>(listVertices(edge, list));
  for (std::size_t face = 0; face < 2; ++face) {
    if (!edge.crosses[face]) continue;
    std::uint32_t rank = edge.parameter[face] <= 0.0f && open[0] ? 0 : edge.count + 1;
    for (std::uint32_t k = 0; k < edge.count; ++k)
      if (list[k].t == edge.parameter[face]) rank = k + 1;
    edge.rank[face] = rank;
  }
}

std::size_t listVertices(const CrossedEdge& edge, EdgeVertexList& list) {
  std::size_t size = 0;
  for (std::uint32_t k = 1; k < edge.segments; ++k) list[size++] = {sampleParameter(k, edge.segments), k};
  for (std::size_t face = 0; face < 2; ++face) {
    if (!edge.own[face]) continue;
    std::size_t at = size++;
    for (; at > 0 && list[at - 1].t > edge.parameter[face]; --at) list[at] = list[at - 1];
    list[at] = {edge.parameter[face], 0};
  }
  return size;
}

}  // namespace limn::silhouette
