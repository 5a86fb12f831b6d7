// Edges from triangles, by sorting.
//
// Based on: nothing more than stable counting sorts, so that the time is linear in vertices and triangles for
// any input (a hash table's is not for an input made to hurt it) and the result depends on nothing but the
// arrays.
#include "silhouette/topology.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>

#include "raster/base/check.h"
#include "raster/base/elementary.h"

namespace limn::silhouette {
namespace {

using Indices = std::vector<std::uint32_t>;

// Sorts `order` by key(order[k]) < keys, keeping the order of equal keys; `spare` has the same length.
template <class Key>
void sortStably(Indices& order, Indices& spare, Indices& starts, std::size_t keys, const Key& key) {
  starts.assign(keys + 1, 0);
  for (const std::uint32_t item : order) ++starts[key(item) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  for (const std::uint32_t item : order) spare[starts[key(item)]++] = item;
  order.swap(spare);
}

// The bits of a coordinate, equal exactly for equal numbers.
std::uint32_t bitsOf(float x) {
  return std::bit_cast<std::uint32_t>(x == 0.0f ? 0.0f : x);
}

// Numbers the positions in the order of their first vertices; returns how many there are.
std::size_t weld(std::span<const glm::vec3> positions, Indices& points) {
  Indices order(positions.size()), spare(positions.size()), starts;
  std::iota(order.begin(), order.end(), 0u);
  // Few vertices are sorted by short digits: counting 2^16 long ones would take longer than sorting them.
  constexpr std::size_t kFew = 1U << 14;
  const std::uint32_t bits = positions.size() < kFew ? 8 : 16, digits = 1U << bits;
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint32_t shift = 0; shift < 32; shift += bits)
      sortStably(order, spare, starts, digits,
                 [&](std::uint32_t v) { return bitsOf(positions[v][axis]) >> shift & (digits - 1); });

  // Equal positions are now neighbours, the first vertex of each group in front: it stands for the group.
  points.resize(positions.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
    points[order[k]] = same ? points[order[k - 1]] : order[k];
  }
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < points.size(); ++v) points[v] = points[v] == v ? count++ : points[points[v]];
  return count;
}

// Repeated point, or an area that is nothing beside the longest side's square.
bool hasNoArea(const Mesh& mesh, std::span<const std::uint32_t> points, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  if (points[corner[0]] == points[corner[1]] || points[corner[1]] == points[corner[2]] ||
      points[corner[2]] == points[corner[0]])
    return true;
  const glm::dvec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return !(glm::length(glm::cross(b - a, c - a)) > 1e-12 * longest);
}

bool isOpposed(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const glm::dvec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
  const glm::vec3 sum = mesh.normals[corner[0]] + mesh.normals[corner[1]] + mesh.normals[corner[2]];
  return glm::dot(glm::cross(b - a, c - a), glm::dvec3(sum)) < 0.0;
}

// The sides of all triangles with their welded end points; side 3 t + k is side k of triangle t.
struct Sides {
  const Mesh& mesh;
  const Indices& points;

  std::uint32_t from(std::uint32_t side) const { return points[mesh.indices[side]]; }
  std::uint32_t to(std::uint32_t side) const { return points[mesh.indices[nextInTriangle(side)]]; }
  std::uint32_t low(std::uint32_t side) const { return std::min(from(side), to(side)); }
  std::uint32_t high(std::uint32_t side) const { return std::max(from(side), to(side)); }
  bool ascends(std::uint32_t side) const { return from(side) < to(side); }
};

Side sideOf(std::uint32_t side) {
  return {side / 3, side % 3};
}

}  // namespace

Topology::Topology(const Mesh& mesh, float featureDegrees) {
  require(mesh.indices.size() % 3 == 0, "three indices per triangle");
  require(mesh.normals.size() == mesh.positions.size(), "one normal per position");
  require(mesh.indices.size() < kNone && mesh.positions.size() < kNone,
          "fewer than 2^32 - 1 indices and vertices");
  require(std::all_of(mesh.indices.begin(), mesh.indices.end(),
                      [&](std::uint32_t index) { return index < mesh.positions.size(); }),
          "index out of range");
  require(featureDegrees >= 0.0f && featureDegrees <= 180.0f, "featureDegrees must be 0 to 180");

  pointCount_ = weld(mesh.positions, points_);
  degenerate_.resize(mesh.triangleCount());
  for (std::size_t t = 0; t < degenerate_.size(); ++t) {
    degenerate_[t] = hasNoArea(mesh, points_, t) ? 1 : 0;
    if (degenerate_[t] != 0)
      ++report_.degenerateTriangles;
    else if (isOpposed(mesh, t))
      ++report_.opposedTriangles;
  }
  findEdges(mesh);
  findFeatures(mesh, featureDegrees);
  for (const Edge& edge : edges_) {
    if (edge.nonManifold)
      ++report_.nonManifoldEdges;
    else if (edge.boundary)
      ++report_.boundaryEdges;
    if (edge.isFeature()) ++report_.featureEdges;
  }
}

void Topology::findEdges(const Mesh& mesh) {
  // A triangle without area but with three different points has neighbours that would part from it if they
  // curved: its sides take part in the count and make their edges non-manifold. One with a repeated point
  // hides nothing.
  const Sides sides{mesh, points_};
  Indices order, spare, starts;
  order.reserve(mesh.indices.size());
  for (std::uint32_t side = 0; side < mesh.indices.size(); ++side) {
    const std::uint32_t first = side - side % 3;
    const bool threePoints = sides.from(first) != sides.from(first + 1) &&
                             sides.from(first + 1) != sides.from(first + 2) &&
                             sides.from(first + 2) != sides.from(first);
    if (threePoints) order.push_back(side);
  }
  spare.resize(order.size());
  sortStably(order, spare, starts, pointCount_, [&](std::uint32_t side) { return sides.high(side); });
  sortStably(order, spare, starts, pointCount_, [&](std::uint32_t side) { return sides.low(side); });

  sideEdges_.assign(mesh.indices.size(), kNone);
  edges_.reserve(order.size() / 2);
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && sides.low(order[end]) == sides.low(order[begin]) &&
           sides.high(order[end]) == sides.high(order[begin]))
      ++end;
    addEdges(mesh, std::span(order).subspan(begin, end - begin));
  }
}

void Topology::addEdges(const Mesh& mesh, std::span<const std::uint32_t> group) {
  const Sides sides{mesh, points_};
  Edge edge;
  edge.point = {sides.low(group[0]), sides.high(group[0])};
  const bool whole = std::none_of(group.begin(), group.end(),
                                  [&](std::uint32_t side) { return degenerate_[side / 3] != 0; });
  if (whole && group.size() == 2 && sides.ascends(group[0]) != sides.ascends(group[1])) {
    const std::size_t ascending = sides.ascends(group[0]) ? 0 : 1;
    edge.faces = {sideOf(group[ascending]), sideOf(group[1 - ascending])};
    sideEdges_[group[0]] = sideEdges_[group[1]] = static_cast<std::uint32_t>(edges_.size());
    edges_.push_back(edge);
    return;
  }
  edge.boundary = true;
  edge.nonManifold = !whole || group.size() > 1;
  for (const std::uint32_t side : group) {
    if (degenerate_[side / 3] != 0) continue;
    edge.faces[0] = sideOf(side);
    edge.descending = !sides.ascends(side);
    sideEdges_[side] = static_cast<std::uint32_t>(edges_.size());
    edges_.push_back(edge);
  }
}

void Topology::findFeatures(const Mesh& mesh, float featureDegrees) {
  // |n_s - n_t| of unit normals is twice the sine of half their angle; the last bits are those of the
  // normals.
  const double chord = 2.0 * sinCosDegrees(0.5 * featureDegrees).sin;
  for (Edge& edge : edges_) {
    if (edge.boundary) continue;
    const EdgeVertices v = edgeVertices(mesh, edge);
    for (int end = 0; end < 2; ++end) {
      const glm::dvec3 difference = glm::dvec3(mesh.normals[v[0][end]]) - glm::dvec3(mesh.normals[v[1][end]]);
      edge.feature[end] = glm::dot(difference, difference) > chord * chord;
    }
  }
}

EdgeVertices edgeVertices(const Mesh& mesh, const Edge& edge) {
  EdgeVertices vertices{};
  for (std::size_t face = 0; face < 2; ++face) {
    if (edge.faces[face].triangle == kNone) {
      vertices[face] = vertices[0];
      continue;
    }
    const std::uint32_t side = 3 * edge.faces[face].triangle + edge.faces[face].side;
    const std::array<std::uint32_t, 2> along{mesh.indices[side], mesh.indices[nextInTriangle(side)]};
    vertices[face] = edge.runsBack(face) ? std::array{along[1], along[0]} : along;
  }
  return vertices;
}

bool Topology::isConsistent(const Mesh& mesh) const {
  if (points_.size() != mesh.positions.size() || sideEdges_.size() != mesh.indices.size()) return false;
  for (const std::uint32_t point : points_)
    if (point >= pointCount_) return false;

  // Every face of every edge names a side that names the edge, runs as it says and has its points.
  std::vector<std::uint8_t> faces(edges_.size(), 0);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    if (!(edge.point[0] < edge.point[1]) || edge.faces[0].triangle == kNone) return false;
    if (edge.boundary != (edge.faces[1].triangle == kNone)) return false;
    if ((edge.nonManifold || edge.descending) && !edge.boundary) return false;
    if (edge.boundary && edge.isFeature()) return false;
    for (std::size_t face = 0; face < 2; ++face) {
      const Side& side = edge.faces[face];
      if (side.triangle == kNone) continue;
      const std::size_t index = 3 * std::size_t{side.triangle} + side.side;
      if (side.side > 2 || index >= sideEdges_.size() || sideEdges_[index] != e) return false;
      const std::array<std::uint32_t, 2> vertices = edgeVertices(mesh, edge)[face];
      if (points_[vertices[0]] != edge.point[0] || points_[vertices[1]] != edge.point[1]) return false;
      ++faces[e];
    }
  }
  // And every side of every other triangle has an edge with as many faces as sides that name it.
  for (std::size_t side = 0; side < sideEdges_.size(); ++side) {
    if ((sideEdges_[side] == kNone) != isDegenerate(side / 3)) return false;
    if (sideEdges_[side] == kNone) continue;
    if (sideEdges_[side] >= edges_.size() || faces[sideEdges_[side]]-- == 0) return false;
  }
  return std::all_of(faces.begin(), faces.end(), [](std::uint8_t left) { return left == 0; });
}

}  // namespace limn::silhouette
