// Based on: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5, for the point of a triangle; the hierarchy
// is the plain one of median splits. Differs in: triangles that face away from the query's normal are passed over, so
// that thin parts do not attract what belongs to their other side.
#include "apps/coarsen/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "silhouette/topology.h"

namespace limn::coarsen {
namespace {

using glm::dot;
using glm::dvec3;

constexpr Index kLeafSize = 4;

double boxDistance2(const dvec3& low, const dvec3& high, const dvec3& query) {
  const dvec3 d = glm::max(glm::max(low - query, query - high), dvec3(0.0));
  return dot(d, d);
}

// Weights of the point of triangle abc that is closest to q.
std::array<double, 3> closestWeights(const dvec3& q, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 ab = b - a, ac = c - a, aq = q - a, bq = q - b, cq = q - c;
  const double d1 = dot(ab, aq), d2 = dot(ac, aq);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  const double d3 = dot(ab, bq), d4 = dot(ac, bq);
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = d1 / (d1 - d3);
    return {1.0 - v, v, 0.0};
  }
  const double d5 = dot(ab, cq), d6 = dot(ac, cq);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return {1.0 - w, 0.0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - w, w};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0.0)) return {1.0, 0.0, 0.0};
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

Surface makeSurface(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                    std::span<const Index> indices, std::vector<Index>* pointOf) {
  const silhouette::Mesh mesh{positions, normals, indices};
  const silhouette::Topology topology(mesh, 1.0f);
  Surface surface;
  surface.points.resize(topology.pointCount());
  for (std::size_t v = 0; v < positions.size(); ++v)
    surface.points[topology.points()[v]] = dvec3(positions[v]);
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const std::array<Index, 3> p = {topology.points()[indices[3 * t]], topology.points()[indices[3 * t + 1]],
                                    topology.points()[indices[3 * t + 2]]};
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
    surface.corners.insert(surface.corners.end(), p.begin(), p.end());
    surface.triangles.push_back(t);
    const dvec3 normal =
        glm::cross(surface.points[p[1]] - surface.points[p[0]], surface.points[p[2]] - surface.points[p[0]]);
    const double length = glm::length(normal);
    surface.normals.push_back(length > 0.0 ? normal / length : dvec3(0.0));
    surface.areas.push_back(0.5 * length);
  }
  for (const silhouette::Edge& edge : topology.edges())
    if (edge.boundary || edge.isFeature()) surface.lines.push_back(edge.point);
  if (pointOf != nullptr) *pointOf = topology.points();
  return surface;
}

ClosestPoint::ClosestPoint(std::span<const dvec3> points, std::span<const Index> corners)
    : points_(points), corners_(corners) {
  const auto count = static_cast<Index>(corners.size() / 3);
  std::vector<dvec3> centers(count);
  normals_.resize(count);
  order_.resize(count);
  for (Index t = 0; t < count; ++t) {
    const dvec3 &a = points[corners[3 * t]], &b = points[corners[3 * t + 1]], &c = points[corners[3 * t + 2]];
    order_[t] = t;
    centers[t] = (a + b + c) / 3.0;
    normals_[t] = glm::cross(b - a, c - a);
  }
  nodes_.reserve(count);
  if (count > 0) build(centers, 0, count);
}

Index ClosestPoint::build(std::span<const dvec3> centers, Index begin, Index end) {
  const auto id = static_cast<Index>(nodes_.size());
  nodes_.emplace_back();
  dvec3 low(std::numeric_limits<double>::infinity()), high = -low, centerLow = low, centerHigh = high;
  for (Index k = begin; k < end; ++k) {
    for (Index corner = 0; corner < 3; ++corner) {
      low = glm::min(low, points_[corners_[3 * order_[k] + corner]]);
      high = glm::max(high, points_[corners_[3 * order_[k] + corner]]);
    }
    centerLow = glm::min(centerLow, centers[order_[k]]);
    centerHigh = glm::max(centerHigh, centers[order_[k]]);
  }
  Node node{low, high, begin, end, true};
  if (end - begin > kLeafSize) {
    const dvec3 extent = centerHigh - centerLow;
    const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
    const Index middle = begin + (end - begin) / 2;
    const auto less = [&](Index a, Index b) {
      return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b;
    };
    // The halves are sets that do not depend on how nth_element works, since no two elements are equal.
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, less);
    node.leaf = false;
    node.first = build(centers, begin, middle);
    node.second = build(centers, middle, end);
  } else {
    std::sort(order_.begin() + begin, order_.begin() + end);
  }
  nodes_[id] = node;
  return id;
}

std::optional<Touch> ClosestPoint::find(const dvec3& query, const dvec3& facing) const {
  Touch best;
  if (nodes_.empty()) return std::nullopt;
  const bool oriented = facing != dvec3(0.0);
  std::array<Index, 64> stack{};  // median splits: the depth is the logarithm of the count
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (boxDistance2(node.low, node.high, query) >= best.distance2) continue;
    if (!node.leaf) {
      const Node &first = nodes_[node.first], &second = nodes_[node.second];
      const bool firstNearer =
          boxDistance2(first.low, first.high, query) < boxDistance2(second.low, second.high, query);
      stack[depth++] = firstNearer ? node.second : node.first;
      stack[depth++] = firstNearer ? node.first : node.second;
      continue;
    }
    for (Index k = node.first; k < node.second; ++k) {
      const Index t = order_[k];
      if (oriented && dot(normals_[t], facing) <= 0.0) continue;
      const dvec3 &a = points_[corners_[3 * t]], &b = points_[corners_[3 * t + 1]],
                  &c = points_[corners_[3 * t + 2]];
      const std::array<double, 3> w = closestWeights(query, a, b, c);
      const dvec3 point = w[0] * a + w[1] * b + w[2] * c;
      const double distance2 = dot(point - query, point - query);
      if (distance2 < best.distance2) best = {t, w, point, distance2};
    }
  }
  if (best.distance2 == std::numeric_limits<double>::infinity()) return std::nullopt;
  return best;
}

}  // namespace limn::coarsen
