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
constexpr float kLimit = 1.25f;     // of an end's offset to the other's
constexpr float kSharpTurn = 0.9f;  // cosine: a polyline that turns more is cut

// The feature edges at a point, if they are two.
struct Meeting {
  std::array<std::uint32_t, 2> edges{kNone, kNone};
  std::uint32_t count = 0;
};

// The vectors along an edge, away from its end `end`.
vec3 awayFrom(const Mesh& mesh, const Edge& edge, std::size_t end) {
  const std::array<std::uint32_t, 2> v = edgeVertices(mesh, edge)[0];
  return mesh.positions[v[1 - end]] - mesh.positions[v[end]];
}

// What the curve adds to a third of the edge at its end `end`; zero at corners, open ends and cuts.
vec3 endOffset(const Mesh& mesh, const Topology& topology, const std::vector<Meeting>& meetings,
               std::uint32_t e, std::size_t end) {
  const Edge& edge = topology.edges()[e];
  const Meeting& meeting = meetings[edge.point[end]];
  if (meeting.count != 2) return vec3(0.0f);
  const std::uint32_t otherEdge = meeting.edges[meeting.edges[0] == e ? 1 : 0];
  const Edge& other = topology.edges()[otherEdge];
  const vec3 on = awayFrom(mesh, edge, end);
  const vec3 to = -awayFrom(mesh, other, other.point[0] == edge.point[end] ? 0 : 1);
  const float along = dot(on, to);
  if (!(along > 0.0f) || along * along < kSharpTurn * kSharpTurn * dot(on, on) * dot(to, to))
    return vec3(0.0f);
  const vec3 tangent = glm::normalize(circleTangent(to, on));
  const float length = glm::length(on);
  const float cosine = dot(tangent, on) / length;
  return (2.0f * length / (1.0f + cosine) * tangent - on) / 3.0f;  // (L)
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
  std::vector<Meeting> meetings(topology.pointCount());
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    if (!edges[e].isFeature()) continue;
    for (const std::uint32_t point : edges[e].point) {
      Meeting& meeting = meetings[point];
      if (meeting.count < 2) meeting.edges[meeting.count] = e;
      ++meeting.count;
    }
  }
  crew.forBlocks(edges.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (!edges[e].isFeature()) continue;
      const auto edge = static_cast<std::uint32_t>(e);
      curves[e] =
          limited(endOffset(mesh, topology, meetings, edge, 0), endOffset(mesh, topology, meetings, edge, 1));
    }
  });
}

}  // namespace limn::silhouette
