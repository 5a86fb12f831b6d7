// Based on: M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", 1997; H. Hoppe, "New quadric
// metric for simplifying meshes with appearance attributes", 1999, for wedges; T. Dey, H. Edelsbrunner, S. Guha, D.
// Nekhayev, "Topology preserving edge contraction", 1999, for the link condition.
// Differs in: quadrics are weighted by how much of the outline a face makes, which an off-the-shelf simplifier does not
// take; a vertex only moves onto its neighbour, so that attributes stay those of the source, bit for bit.
#include "apps/coarsen/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>

namespace limn::coarsen {
namespace {

using glm::dot;
using glm::dvec3;

constexpr double kBoundaryWeight = 10.0;  // of a squared distance from a boundary, per squared length
constexpr double kShortness = 1e-6;       // of a squared edge length, so that flat parts get fair triangles
constexpr double kLeastTurn = 0.2;        // cosine of the angle by which a face may turn in one step
constexpr double kLeastFatness = 0.04;    // of a triangle: its height over its longest side
constexpr double kThinning = 0.5;         // what a sliver keeps of that at least in one step
constexpr float kTextureJump = 4.0f;      // per unit of texture coordinates, against cosines of normals
constexpr std::size_t kMostNeighbours = 24;  // of both ends together

/// Sum of weighted squared distances from planes.
class Quadric {
 public:
  void addPlane(const dvec3& n, double d, double w) {
    const std::array<double, 10> plane = {n.x * n.x, n.x * n.y, n.x * n.z, n.x * d, n.y * n.y,
                                          n.y * n.z, n.y * d,   n.z * n.z, n.z * d, d * d};
    for (std::size_t i = 0; i < plane.size(); ++i) a_[i] += w * plane[i];
    weight_ += w;
  }
  void add(const Quadric& other) {
    for (std::size_t i = 0; i < a_.size(); ++i) a_[i] += other.a_[i];
    weight_ += other.weight_;
  }
  double at(const dvec3& p) const {
    return p.x * (a_[0] * p.x + 2.0 * (a_[1] * p.y + a_[2] * p.z + a_[3])) +
           p.y * (a_[4] * p.y + 2.0 * (a_[5] * p.z + a_[6])) + p.z * (a_[7] * p.z + 2.0 * a_[8]) + a_[9];
  }
  double weight() const { return weight_; }

 private:
  std::array<double, 10> a_{};
  double weight_ = 0.0;
};

/// Of a triangle: its normal, twice its area long, and that length over the square of the longest side.
struct Shape {
  dvec3 normal;
  double fatness;

  explicit Shape(const std::array<dvec3, 3>& p) : normal(glm::cross(p[1] - p[0], p[2] - p[0])) {
    const dvec3 a = p[1] - p[0], b = p[2] - p[1], c = p[0] - p[2];
    const double longest2 = std::max({dot(a, a), dot(b, b), dot(c, c)});
    fatness = longest2 > 0.0 ? glm::length(normal) / longest2 : 0.0;
  }
  bool isSliver() const { return fatness < kLeastFatness; }
};

/// Moving point `from` onto point `to`.
struct Collapse {
  double cost = 0.0;
  Index from = 0, to = 0, fromVersion = 0, toVersion = 0;

  // Turned round for std::priority_queue: the cheapest comes first, ties by the points.
  bool operator<(const Collapse& other) const {
    if (cost != other.cost) return cost > other.cost;
    return from != other.from ? from > other.from : to > other.to;
  }
};

/// What may be lost where nothing else is left to collapse.
struct Rules {
  bool seamsGiveWay, makesSlivers;
};

/// What the corners of one material with one vertex at `from` become at `to`.
struct WedgeMove {
  Index wedge = 0, group = 0, target = 0;
};

class Simplifier {
 public:
  explicit Simplifier(const SimplifyInput& input)
      : in_(input), points_(input.surface.points), left_(input.surface.triangleCount()) {
    const std::size_t faces = left_;
    wedges_.reserve(3 * faces);
    for (const Index t : in_.surface.triangles)
      for (Index corner = 0; corner < 3; ++corner)
        wedges_.push_back(in_.indices[3 * std::size_t{t} + corner]);
    alive_.assign(faces, true);
    facesOf_.resize(points_.size());
    boundary_.assign(points_.size(), false);
    version_.assign(points_.size(), 0);
    quadrics_.resize(points_.size());
    for (Index side = 0; side < wedges_.size(); ++side) facesOf_[pointAt(side)].push_back(side / 3);
    for (Index face = 0; face < faces; ++face) addQuadrics(face);
  }

  Simplified run(std::size_t triangles, const std::function<void(double)>& progress) {
    const std::size_t first = left_;
    for (const Rules rules : {Rules{false, false}, Rules{true, false}, Rules{true, true}}) {
      std::size_t before = left_ + 1;
      while (left_ > triangles && left_ < before) {
        before = left_;
        fillQueue();
        while (left_ > triangles && !queue_.empty()) {
          const Collapse next = queue_.top();
          queue_.pop();
          if (version_[next.from] != next.fromVersion || version_[next.to] != next.toVersion) continue;
          if (tryCollapse(next.from, next.to, rules) && progress && left_ % 1024 < 2 && first > triangles)
            progress(static_cast<double>(first - left_) / static_cast<double>(first - triangles));
        }
      }
    }
    Simplified out;
    for (Index face = 0; face < alive_.size(); ++face) {
      if (!alive_[face]) continue;
      out.indices.insert(out.indices.end(), wedges_.begin() + 3 * face, wedges_.begin() + 3 * face + 3);
      out.triangles.push_back(in_.surface.triangles[face]);
    }
    return out;
  }

 private:
  Index pointAt(std::size_t side) const { return in_.pointOf[wedges_[side]]; }
  Index groupAt(Index face) const { return in_.groupOf[in_.surface.triangles[face]]; }

  void addQuadrics(Index face) {
    const Surface& s = in_.surface;
    const Index* p = &s.corners[3 * std::size_t{face}];
    const double weight = (in_.weights[p[0]] + in_.weights[p[1]] + in_.weights[p[2]]) / 3.0;
    const dvec3 normal = s.normals[face];
    for (int k = 0; k < 3; ++k)
      quadrics_[p[k]].addPlane(normal, -dot(normal, points_[p[0]]), weight * s.areas[face]);
    for (int k = 0; k < 3; ++k) {
      const Index a = p[k], b = p[(k + 1) % 3];
      if (countFacesWith(a, b) != 1) continue;
      boundary_[a] = boundary_[b] = true;
      const dvec3 along = points_[b] - points_[a], across = glm::cross(along, normal);
      const double length = glm::length(across);
      if (!(length > 0.0)) continue;
      const dvec3 side = across / length;
      for (const Index end : {a, b})
        quadrics_[end].addPlane(side, -dot(side, points_[a]), kBoundaryWeight * weight * dot(along, along));
    }
  }

  bool hasPoint(Index face, Index point) const {
    return pointAt(3 * face) == point || pointAt(3 * face + 1) == point || pointAt(3 * face + 2) == point;
  }
  std::size_t countFacesWith(Index a, Index b) const {
    return static_cast<std::size_t>(
        std::count_if(facesOf_[a].begin(), facesOf_[a].end(), [&](Index face) { return hasPoint(face, b); }));
  }
  void neighbours(Index point, std::vector<Index>& out) const {
    out.clear();
    for (const Index face : facesOf_[point])
      for (Index corner = 0; corner < 3; ++corner)
        if (const Index other = pointAt(3 * face + corner); other != point) out.push_back(other);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }

  void push(Index from, Index to) {
    const dvec3 edge = points_[to] - points_[from];
    const double error = quadrics_[from].at(points_[to]) + quadrics_[to].at(points_[to]);
    queue_.push({std::max(error, 0.0) + kShortness * quadrics_[from].weight() * dot(edge, edge), from, to,
                 version_[from], version_[to]});
  }
  void fillQueue() {
    queue_ = {};
    for (Index point = 0; point < points_.size(); ++point) {
      neighbours(point, around_);
      for (const Index other : around_) push(point, other);
    }
  }

  // The link condition: the surface stays the same but for its coordinates.
  bool keepsTopology(Index from, Index to) {
    const std::size_t shared = countFacesWith(from, to);
    if (shared == 0 || shared > 2) return false;
    if (boundary_[from] && (!boundary_[to] || shared != 1)) return false;
    neighbours(from, around_);
    neighbours(to, aroundOther_);
    if (around_.size() + aroundOther_.size() > kMostNeighbours) return false;
    // Nothing is left of a tetrahedron, or of a lone triangle: both ends have no other neighbours than their common ones.
    if (around_.size() == shared + 1 && aroundOther_.size() == shared + 1) return false;
    // One fan of faces around `from`: as many as neighbours, or one less at a boundary.
    if (facesOf_[from].size() + (boundary_[from] ? 1 : 0) != around_.size()) return false;
    std::size_t common = 0;
    for (const Index point : around_)
      if (std::binary_search(aroundOther_.begin(), aroundOther_.end(), point)) ++common;
    return common == shared;
  }

  std::array<dvec3, 3> placesOf(Index face) const {
    return {points_[pointAt(3 * face)], points_[pointAt(3 * face + 1)], points_[pointAt(3 * face + 2)]};
  }
  // No face turns over, and none becomes a sliver. One that is a sliver already may get thinner, since the needles between
  // clusters of near points must do so before they can go; its plane does not say which side of it is out.
  bool keepsShape(Index from, Index to, const Rules& rules) const {
    for (const Index face : facesOf_[from]) {
      if (hasPoint(face, to)) continue;
      std::array<dvec3, 3> places = placesOf(face);
      const Shape before(places);
      for (Index corner = 0; corner < 3; ++corner)
        if (pointAt(3 * face + corner) == from) places[corner] = points_[to];
      const Shape after(places);
      if (!rules.makesSlivers && after.isSliver() && after.fatness < kThinning * before.fatness) return false;
      const dvec3 side = before.isSliver() ? vertexNormals(face) : before.normal;
      if (dot(side, after.normal) < kLeastTurn * glm::length(side) * glm::length(after.normal)) return false;
    }
    return true;
  }
  dvec3 vertexNormals(Index face) const {
    dvec3 sum(0.0);
    for (Index corner = 0; corner < 3; ++corner) sum += dvec3(in_.normals[wedges_[3 * face + corner]]);
    return sum;
  }

  // Fills moves_ from the faces that vanish; false where they leave a wedge without a successor or with two.
  bool mapWedges(Index from, Index to) {
    moves_.clear();
    for (const Index face : facesOf_[from]) {
      if (!hasPoint(face, to)) continue;
      WedgeMove move{0, groupAt(face), 0};
      for (Index corner = 0; corner < 3; ++corner) {
        if (pointAt(3 * face + corner) == from) move.wedge = wedges_[3 * face + corner];
        if (pointAt(3 * face + corner) == to) move.target = wedges_[3 * face + corner];
      }
      const WedgeMove* known = findMove(move.wedge, move.group);
      if (known != nullptr && known->target != move.target) return false;
      if (known == nullptr) moves_.push_back(move);
    }
    return std::all_of(facesOf_[from].begin(), facesOf_[from].end(),
                       [&](Index face) { return findMove(wedgeAt(face, from), groupAt(face)) != nullptr; });
  }
  const WedgeMove* findMove(Index wedge, Index group) const {
    const auto found = std::find_if(moves_.begin(), moves_.end(),
                                    [&](const WedgeMove& m) { return m.wedge == wedge && m.group == group; });
    return found != moves_.end() ? &*found : nullptr;
  }
  Index wedgeAt(Index face, Index point) const {
    for (Index corner = 0; corner < 2; ++corner)
      if (pointAt(3 * face + corner) == point) return wedges_[3 * face + corner];
    return wedges_[3 * face + 2];
  }

  // Across a seam: the vertex at `to` that is the closest in its normal and its texture, of the same material where it has one
  // there.
  Index likeliestWedge(Index face, Index from, Index to) const {
    const Index old = wedgeAt(face, from);
    const glm::vec3 normal = in_.normals[old];
    Index best = kNone;
    float bestScore = -std::numeric_limits<float>::infinity();
    for (const Index other : facesOf_[to]) {
      const Index wedge = wedgeAt(other, to);
      float score = glm::dot(normal, in_.normals[wedge]) + (groupAt(other) == groupAt(face) ? 8.0f : 0.0f);
      if (!in_.texcoords.empty())
        score -= kTextureJump * std::min(1.0f, glm::distance(in_.texcoords[old], in_.texcoords[wedge]));
      if (score > bestScore) {
        bestScore = score;
        best = wedge;
      }
    }
    return best;
  }

  bool tryCollapse(Index from, Index to, const Rules& rules) {
    if (!keepsTopology(from, to) || !keepsShape(from, to, rules)) return false;
    if (!mapWedges(from, to) && !rules.seamsGiveWay) return false;
    std::vector<Index>& kept = facesOf_[to];
    std::vector<std::array<Index, 2>> changes;  // side, wedge: decided before anything changes
    for (const Index face : facesOf_[from]) {
      if (hasPoint(face, to)) continue;
      const WedgeMove* move = findMove(wedgeAt(face, from), groupAt(face));
      const Index wedge = move != nullptr ? move->target : likeliestWedge(face, from, to);
      for (Index corner = 0; corner < 3; ++corner)
        if (pointAt(3 * face + corner) == from) changes.push_back({3 * face + corner, wedge});
    }
    for (const Index face : facesOf_[from]) {
      if (!hasPoint(face, to)) continue;
      alive_[face] = false;
      --left_;
      for (Index corner = 0; corner < 3; ++corner)
        if (const Index point = pointAt(3 * face + corner); point != from) std::erase(facesOf_[point], face);
    }
    for (const std::array<Index, 2>& change : changes) {
      wedges_[change[0]] = change[1];
      kept.push_back(change[0] / 3);
    }
    facesOf_[from].clear();
    quadrics_[to].add(quadrics_[from]);
    ++version_[from];
    ++version_[to];
    neighbours(to, around_);
    for (const Index other : around_) {
      push(to, other);
      push(other, to);
    }
    return true;
  }

  const SimplifyInput& in_;
  const std::vector<dvec3>& points_;
  std::size_t left_;
  std::vector<Index> wedges_;  // vertex of each side's start
  std::vector<bool> alive_, boundary_;
  std::vector<std::vector<Index>> facesOf_;
  std::vector<Index> version_;
  std::vector<Quadric> quadrics_;
  std::priority_queue<Collapse> queue_;
  std::vector<Index> around_, aroundOther_;
  std::vector<WedgeMove> moves_;
};

}  // namespace

Simplified simplify(const SimplifyInput& input, std::size_t triangles,
                    const std::function<void(double)>& progress) {
  return Simplifier(input).run(triangles, progress);
}

}  // namespace limn::coarsen
