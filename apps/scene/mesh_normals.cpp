// Based on: G. Thürmer and C. A. Wüthrich, "Computing vertex normals from polygonal facets", Journal of
// Graphics Tools 3(1), 1998: facet normals weighted by the angle at the vertex. Differs in: the facets around
// a point are divided into groups at edges that turn by more than the crease angle, at boundaries and where
// more than two facets meet.
#include "apps/scene/mesh_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

/// Unit normal of a triangle, 0 where it has no area.
glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

struct Corners {
  std::span<const glm::vec3> positions;
  std::span<const std::uint32_t> indices;
  std::span<const std::uint32_t> places;

  std::uint32_t vertex(std::size_t corner) const { return indices[places[corner]]; }
  glm::dvec3 position(std::size_t corner) const { return positions[vertex(corner)]; }
  std::size_t triangles() const { return places.size() / 3; }

  glm::dvec3 faceNormal(std::size_t triangle) const {
    const glm::dvec3 a = position(3 * triangle), b = position(3 * triangle + 1),
                     c = position(3 * triangle + 2);
    return unitOrZero(glm::cross(b - a, c - a));
  }

  double angle(std::size_t corner) const {
    const std::size_t first = corner / 3 * 3;
    const glm::dvec3 p = position(corner);
    const glm::dvec3 u = unitOrZero(position(first + (corner + 1) % 3) - p);
    const glm::dvec3 v = unitOrZero(position(first + (corner + 2) % 3) - p);
    return arcCosine(glm::dot(u, v));
  }
};

/// For each corner the lowest-numbered corner at the same position; -0 equals +0.
std::vector<std::uint32_t> weld(const Corners& corners) {
  std::vector<std::uint32_t> order(corners.places.size()), point(order.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t corner) {
    const glm::vec3& p = corners.positions[corners.vertex(corner)];
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isNew = i == 0 || key(order[i]) != key(order[i - 1]);
    point[order[i]] = isNew ? order[i] : point[order[i - 1]];
  }
  return point;
}

/// Sets that can be joined; each is named after its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct HalfEdge {
  std::uint32_t low = 0, high = 0;  ///< points
  std::uint32_t corner = 0;         ///< where it starts
  bool isForward = false;           ///< from low to high
};

std::vector<HalfEdge> sortedHalfEdges(const std::vector<std::uint32_t>& points) {
  std::vector<HalfEdge> edges;
  edges.reserve(points.size());
  for (std::uint32_t c = 0; c < points.size(); ++c) {
    const std::uint32_t from = points[c], to = points[c / 3 * 3 + (c + 1) % 3];
    if (from != to) edges.push_back({std::min(from, to), std::max(from, to), c, from < to});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tuple(a.low, a.high, a.corner) < std::tuple(b.low, b.high, b.corner);
  });
  return edges;
}

/// A triangle without area says nothing of the surface: its corners go with whoever else uses their vertex.
void joinCornersWithoutArea(const Corners& corners, const std::vector<glm::dvec3>& faceNormals,
                            DisjointSets& sets) {
  std::vector<std::uint32_t> first(corners.positions.size(), kNone);
  for (const bool withArea : {true, false}) {
    for (std::uint32_t c = 0; c < corners.places.size(); ++c) {
      if ((faceNormals[c / 3] != glm::dvec3(0.0)) != withArea) continue;
      std::uint32_t& other = first[corners.vertex(c)];
      if (other == kNone)
        other = c;
      else if (!withArea)
        sets.join(other, c);
    }
  }
}

/// Joins the corners on both sides of every edge that is smooth.
DisjointSets joinOverSmoothEdges(const Corners& corners, double creaseDegrees) {
  std::vector<glm::dvec3> faceNormals(corners.triangles());
  for (std::size_t t = 0; t < faceNormals.size(); ++t) faceNormals[t] = corners.faceNormal(t);
  const double leastCosine = sinCosDegrees(creaseDegrees).cos;
  const std::vector<HalfEdge> edges = sortedHalfEdges(weld(corners));
  const auto next = [](std::uint32_t corner) { return corner / 3 * 3 + (corner + 1) % 3; };
  DisjointSets sets(corners.places.size());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high)
      ++end;
    if (end - begin != 2 || edges[begin].isForward == edges[begin + 1].isForward) continue;
    const std::uint32_t a = edges[begin].corner, b = edges[begin + 1].corner;
    if (glm::dot(faceNormals[a / 3], faceNormals[b / 3]) < leastCosine) continue;
    sets.join(a, next(b));
    sets.join(next(a), b);
  }
  joinCornersWithoutArea(corners, faceNormals, sets);
  return sets;
}

}  // namespace

NormalGroups groupCorners(std::span<const glm::vec3> positions, std::span<std::uint32_t> indices,
                          std::vector<std::uint32_t> corners, double creaseDegrees) {
  NormalGroups result;
  result.corners = std::move(corners);
  const std::size_t count = result.corners.size();
  DisjointSets sets = joinOverSmoothEdges({positions, indices, result.corners}, creaseDegrees);
  result.groups.resize(count);
  for (std::uint32_t c = 0; c < count; ++c) result.groups[c] = sets.find(c);

  // The first group at a vertex keeps it, the others get a copy each.
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t c) {
    return std::tuple(indices[result.corners[c]], result.groups[c], c);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> vertices(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t vertex = indices[result.corners[order[i]]], group = result.groups[order[i]];
    const bool isSameVertex = i > 0 && indices[result.corners[order[i - 1]]] == vertex;
    if (!isSameVertex) {
      vertices[order[i]] = vertex;
    } else if (result.groups[order[i - 1]] == group) {
      vertices[order[i]] = vertices[order[i - 1]];
    } else {
      vertices[order[i]] = static_cast<std::uint32_t>(positions.size() + result.copies.size());
      result.copies.push_back(vertex);
    }
  }
  for (std::size_t c = 0; c < count; ++c) indices[result.corners[c]] = vertices[c];
  return result;
}

void makeNormals(const NormalGroups& groups, std::span<const glm::vec3> positions,
                 std::span<const std::uint32_t> indices, const glm::vec3& fallback,
                 std::span<glm::vec3> normals) {
  const Corners corners{positions, indices, groups.corners};
  std::vector<glm::dvec3> sums(groups.corners.size(), glm::dvec3(0.0));
  for (std::size_t t = 0; t < corners.triangles(); ++t) {
    const glm::dvec3 normal = corners.faceNormal(t);
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) sums[groups.groups[c]] += corners.angle(c) * normal;
  }
  for (std::size_t c = 0; c < groups.corners.size(); ++c) {
    const glm::dvec3 normal = unitOrZero(sums[groups.groups[c]]);
    normals[corners.vertex(c)] = normal == glm::dvec3(0.0) ? fallback : glm::vec3(normal);
  }
}

}  // namespace limn::scene
