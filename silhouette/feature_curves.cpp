#include "silhouette/feature_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr std::size_t kEdgesPerBlock = 4096;
constexpr float kLimit = 1.25f;        // of an end's offset to the other's
constexpr float kLineNone = 0.035f;    // sines of the angle between the normals: where their planes' line
constexpr float kLineWhole = 0.17f;    // is not believed (2 degrees), and where it alone is (10 degrees)
constexpr float kSharpTurn = 0.9f;     // cosine: a polyline that turns more is cut,
constexpr float kSharpestTurn = 0.5f;  // unless it turns everywhere so, as a coarse circle does, up to this
constexpr float kRegularTurn = 0.4f;   // of 1 - cosine: what both points beside it must have

// The edges that are features at a point, if they are two. (The edges that meet at the tip of a cone are features
// there and not at its rim.)
struct Meeting {
  std::array<std::uint32_t, 2> edges{kNone, kNone};
  std::uint32_t count = 0;
};

// The feature edges of a mesh, by the points where they meet.
struct FeatureGraph {
  const Mesh& mesh;
  const Topology& topology;
  std::vector<Meeting> meetings;  // per point

  vec3 awayFrom(std::uint32_t e, std::uint32_t point) const {
    const Edge& edge = topology.edges()[e];
    const std::array<std::uint32_t, 2> v = edgeVertices(mesh, edge)[0];
    const vec3 along = mesh.positions[v[1]] - mesh.positions[v[0]];
    return edge.point[0] == point ? along : -along;
  }
  std::uint32_t otherPoint(std::uint32_t e, std::uint32_t point) const {
    const Edge& edge = topology.edges()[e];
    return edge.point[edge.point[0] == point ? 1 : 0];
  }
  // Cosine of the turn at a point; -1 where the polyline ends.
  float turn(std::uint32_t point) const {
    const Meeting& meeting = meetings[point];
    if (meeting.count != 2) return -1.0f;
    const vec3 to = -awayFrom(meeting.edges[0], point), on = awayFrom(meeting.edges[1], point);
    return dot(to, on) / std::sqrt(dot(to, to) * dot(on, on));
  }
  bool isInside(std::uint32_t point) const;
  vec3 circleOffset(std::uint32_t e, std::uint32_t point) const;
  vec3 endOffset(std::uint32_t e, std::uint32_t point) const;
};

// Whether the polyline goes on smoothly: it turns a little, or as much as it does before and after.
bool FeatureGraph::isInside(std::uint32_t point) const {
  const float cosine = turn(point);
  if (cosine >= kSharpTurn) return true;
  if (!(cosine >= kSharpestTurn)) return false;
  for (const std::uint32_t e : meetings[point].edges) {
    const float beside = turn(otherPoint(e, point));
    if (beside < kSharpestTurn || 1.0f - beside < kRegularTurn * (1.0f - cosine)) return false;
  }
  return true;
}

// What an arc that leaves along the unit `tangent` adds to a third of the edge: (L). Steeper than 60 degrees it shrinks
// with its projection.
vec3 arcOffset(const vec3& on, const vec3& tangent) {
  const float length = glm::length(on), cosine = dot(tangent, on) / length;
  return (2.0f * length * std::min(1.0f, 2.0f * cosine) / (1.0f + std::max(cosine, 0.5f)) * tangent - on) /
         3.0f;
}

// By the positions of the polyline; zero at corners, open ends and cuts.
vec3 FeatureGraph::circleOffset(std::uint32_t e, std::uint32_t point) const {
  if (!isInside(point)) return vec3(0.0f);
  const Meeting& meeting = meetings[point];
  const vec3 on = awayFrom(e, point), to = -awayFrom(meeting.edges[meeting.edges[0] == e ? 1 : 0], point);
  return arcOffset(on, glm::normalize(circleTangent(to, on)));
}

// By the line in which the tangent planes of both sides meet, where they do; else by the positions.
vec3 FeatureGraph::endOffset(std::uint32_t e, std::uint32_t point) const {
  const Edge& edge = topology.edges()[e];
  const std::size_t end = edge.point[0] == point ? 0 : 1;
  if (!edge.feature[end]) return vec3(0.0f);
  const EdgeVertices v = edgeVertices(mesh, edge);
  const vec3 on = awayFrom(e, point), line = glm::cross(mesh.normals[v[1][end]], mesh.normals[v[0][end]]);
  const float sine = glm::length(line), weight = smoothStep(kLineNone, kLineWhole, sine);
  vec3 offset(0.0f);
  if (weight > 0.0f)
    offset = weight * arcOffset(on, (dot(line, on) < 0.0f ? -1.0f / sine : 1.0f / sine) * line);
  if (weight < 1.0f) offset += (1.0f - weight) * circleOffset(e, point);
  return offset;
}

// An end does not bend much more than the other, nor the other way; with a straight one it is straight.
CurveOffsets limited(const vec3& a, const vec3& b) {
  const float both = dot(a, b);
  const auto scaled = [both](const vec3& offset) {
    const float own = dot(offset, offset);
    return own > 0.0f ? std::clamp(kLimit * both / own, 0.0f, 1.0f) * offset : offset;
  };
  return {scaled(a), scaled(b)};
}

}  // namespace

vec3 circleTangent(const vec3& w0, const vec3& w1) {
  return dot(w1, w1) * w0 + dot(w0, w0) * w1;
}

void computeFeatureCurves(const Mesh& mesh, const Topology& topology, const Crew& crew,
                          std::vector<CurveOffsets>& curves) {
  const std::vector<Edge>& edges = topology.edges();
  FeatureGraph graph{mesh, topology, std::vector<Meeting>(topology.pointCount())};
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    if (!edges[e].isFeature()) continue;
    for (std::size_t end = 0; end < 2; ++end) {
      if (!edges[e].feature[end]) continue;
      Meeting& meeting = graph.meetings[edges[e].point[end]];
      if (meeting.count < 2) meeting.edges[meeting.count] = e;
      ++meeting.count;
    }
  }
  crew.forBlocks(edges.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (!edges[e].isFeature()) continue;
      const auto edge = static_cast<std::uint32_t>(e);
      curves[e] = limited(graph.endOffset(edge, edges[e].point[0]), graph.endOffset(edge, edges[e].point[1]));
    }
  });
}

}  // namespace limn::silhouette
