#include "silhouette/fitted_curves.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace limn::silhouette {
namespace {

using glm::cross;
using glm::dot;
using glm::vec3;

// The frame of an edge seen from p_i; from p_j, along and side have the other sign.
struct EdgeFrame {
  vec3 along{0.0f}, up{0.0f}, side{0.0f};  // unit
  float length = 0.0f;                     // 0: no frame
};

// Normals that leave less than this across the edge would let it turn wildly when the mesh deforms.
constexpr float kLeastAcross = 0.05f;

EdgeFrame edgeFrame(const vec3& pi, const vec3& pj, const vec3& ni, const vec3& nj) {
  EdgeFrame frame;
  const vec3 e = pj - pi;
  const float length = std::sqrt(dot(e, e));
  if (!(length > 0.0f)) return frame;
  frame.along = e / length;
  const vec3 sum = ni + nj;
  const vec3 across = sum - dot(sum, frame.along) * frame.along;
  const float height = std::sqrt(dot(across, across));
  if (!(height > kLeastAcross)) return frame;
  frame.up = across / height;
  frame.side = cross(frame.along, frame.up);
  frame.length = length;
  return frame;
}

}  // namespace

std::array<vec3, 2> fittedOffsets(const vec3& pi, const vec3& pj, const vec3& ni, const vec3& nj,
                                  const FittedEnds& ends) {
  const EdgeFrame f = edgeFrame(pi, pj, ni, nj);
  const auto offset = [&](const vec3& q, const vec3& n, float sign) {
    const float up = q.y - sign * dot(f.along, n) / 3.0f;
    return f.length * (sign * q.x * f.along + up * f.up + sign * q.z * f.side);
  };
  return {offset(ends[0], ni, 1.0f), offset(ends[1], nj, -1.0f)};
}

FittedEnds fittedEnds(const vec3& pi, const vec3& pj, const vec3& ni, const vec3& nj,
                      const std::array<vec3, 2>& offsets) {
  const EdgeFrame f = edgeFrame(pi, pj, ni, nj);
  if (f.length == 0.0f) return {};
  const auto end = [&](const vec3& d, const vec3& n, float sign) {
    return vec3(sign * dot(d, f.along), dot(d, f.up), sign * dot(d, f.side)) / f.length +
           vec3(0.0f, sign * dot(f.along, n) / 3.0f, 0.0f);
  };
  return {end(offsets[0], ni, 1.0f), end(offsets[1], nj, -1.0f)};
}

vec3 fittedCenter(const vec3& p0, const vec3& p1, const vec3& p2, const vec3& center) {
  const vec3 a = p1 - p0, b = p2 - p0, n = cross(a, b);
  const float area = std::sqrt(dot(n, n));
  if (!(area > 0.0f)) return vec3(0.0f);
  return center.x * a + center.y * b + (center.z / std::sqrt(area)) * n;
}

vec3 fittedCenterOf(const vec3& p0, const vec3& p1, const vec3& p2, const vec3& offset) {
  const vec3 a = p1 - p0, b = p2 - p0, n = cross(a, b);
  const float square = dot(n, n);
  if (!(square > 0.0f)) return vec3(0.0f);
  // Cramer's rule in the plane; N / sqrt |N| has length sqrt |N|.
  return {dot(cross(offset, b), n) / square, dot(cross(a, offset), n) / square,
          dot(offset, n) / (std::sqrt(square) * std::sqrt(std::sqrt(square)))};
}

std::array<vec3, 2> endNormals(const Mesh& mesh, const Edge& edge) {
  const EdgeVertices v = edgeVertices(mesh, edge);
  std::array<vec3, 2> normals{};
  for (std::size_t end = 0; end < 2; ++end) {
    const vec3 &first = mesh.normals[v[0][end]], &second = mesh.normals[v[1][end]];
    const vec3 sum = first + second;
    const float length = std::sqrt(dot(sum, sum));
    normals[end] = first != second && length > 1e-3f ? sum / length : first;
  }
  return normals;
}

std::vector<std::uint32_t> edgesAsFirstMet(const Mesh& mesh, const Topology& topology,
                                           std::vector<bool>* runsBack) {
  std::vector<std::uint32_t> order;
  std::vector<bool> met(topology.edges().size(), false);
  order.reserve(met.size());
  if (runsBack != nullptr) runsBack->clear();
  for (std::size_t side = 0; side < topology.sideEdges().size(); ++side) {
    const std::uint32_t edge = topology.sideEdges()[side];
    if (edge == kNone || met[edge]) continue;
    met[edge] = true;
    order.push_back(edge);
    if (runsBack != nullptr)
      runsBack->push_back(topology.points()[mesh.indices[side]] != topology.edges()[edge].point[0]);
  }
  return order;
}

}  // namespace limn::silhouette
