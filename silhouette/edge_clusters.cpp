#include "silhouette/edge_clusters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "silhouette/facing_kernel.h"
#include "silhouette/pixel_bound.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kLongestVector = 16;  // floats

std::uint32_t spread(std::uint32_t x) {  // ten bits, two zeros between
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

// The edges by the Morton code of their midpoints, ties by index.
std::vector<std::uint32_t> mortonOrder(const Mesh& mesh, const Topology& topology) {
  vec3 low(kInfinity), high(-kInfinity);
  for (const vec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<std::uint64_t> keys;
  keys.reserve(topology.edges().size());
  for (std::uint32_t e = 0; e < topology.edges().size(); ++e) {
    const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, topology.edges()[e])[0];
    const vec3 middle = 0.5f * (mesh.positions[ends[0]] + mesh.positions[ends[1]]);
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // No number where the mesh has no extent, or no numbers.
      const float share = (middle[axis] - low[axis]) / (high[axis] - low[axis]);
      const float legal = share > 0.0f ? std::min(share, 1.0f) : 0.0f;
      code |= spread(static_cast<std::uint32_t>(legal * 1023.0f)) << axis;
    }
    keys.push_back(std::uint64_t{code} << 32 | e);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const std::uint64_t key : keys) order.push_back(static_cast<std::uint32_t>(key));
  return order;
}

float lengthOf(const vec3& v) {
  return std::sqrt(dot(v, v));
}

}  // namespace

void EdgeClusters::build(const Mesh& mesh, const Topology& topology) {
  topology_ = &topology;
  order_ = mortonOrder(mesh, topology);
  const std::size_t edges = order_.size();
  clusters_.assign((edges + kEdgesPerCluster - 1) / kEdgesPerCluster, {});
  ends_.resize(edges);
  corners_.assign(clusters_.size() * 6 * kEdgesPerCluster, 0);
  vertices_.clear();
  std::vector<std::uint32_t> own;
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const std::size_t first = c * kEdgesPerCluster, last = std::min(first + kEdgesPerCluster, edges);
    const auto cornerOf = [&](std::size_t place, std::size_t k) {
      const Edge& edge = topology.edges()[order_[place]];
      const Side& face = edge.faces[edge.boundary ? 0 : k / 3];
      return mesh.indices[3 * std::size_t{face.triangle} + (face.side + k) % 3];
    };
    own.clear();
    for (std::size_t place = first; place < last; ++place)
      for (std::size_t k = 0; k < 6; ++k) own.push_back(cornerOf(place, k));
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    Cluster& cluster = clusters_[c];
    for (std::size_t place = first; place < last; ++place) {
      for (std::size_t k = 0; k < 6; ++k)
        corners_[(6 * c + k) * kEdgesPerCluster + place - first] = static_cast<std::uint16_t>(
            std::lower_bound(own.begin(), own.end(), cornerOf(place, k)) - own.begin());
      const EdgeVertices v = edgeVertices(mesh, topology.edges()[order_[place]]);
      ends_[place] = v[0];
      if (v[0] != v[1]) cluster.seams |= std::uint64_t{1} << (place - first);
    }
    cluster.firstVertex = static_cast<std::uint32_t>(vertices_.size());
    cluster.vertexCount = static_cast<std::uint32_t>(own.size());
    vertices_.insert(vertices_.end(), own.begin(), own.end());
    cluster.paddedCount = (cluster.vertexCount + kLongestVector - 1) / kLongestVector * kLongestVector;
    vertices_.resize(cluster.firstVertex + cluster.paddedCount, own.back());
  }
  vertices_.shrink_to_fit();
}

void EdgeClusters::update(const Mesh& mesh, const Topology& topology, const EdgeTest& test,
                          std::span<const CurveOffsets> curves, std::span<const vec3> centers,
                          const Parameters& parameters, const Crew& crew) {
  betas_.assign(clusters_.size() * kEdgesPerCluster, 0.0f);
  bulges_.assign(clusters_.size() * kEdgesPerCluster, 0.0f);
  for (auto* array : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) array->resize(vertices_.size());
  largestBeta_ = test.largestBeta(parameters);
  crew.forBlocks(clusters_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      measureEdges(c, topology, test, curves, centers, parameters);
      boundCluster(c, mesh, test);
    }
  });
}

// The most that edge or patch rise above their flat places: chords by the bound of pixel_bound.h, midpoints by the mean
// of six offsets and 2/9 of a fitted centre's.
void EdgeClusters::measureEdges(std::size_t c, const Topology& topology, const EdgeTest& test,
                                std::span<const CurveOffsets> curves, std::span<const vec3> centers,
                                const Parameters& parameters) {
  Cluster& cluster = clusters_[c];
  cluster.bulge = 0.0f;
  cluster.always = 0;
  for (std::size_t i = 0; i < kEdgesPerCluster && c * kEdgesPerCluster + i < order_.size(); ++i) {
    const std::size_t place = c * kEdgesPerCluster + i;
    const Edge& edge = topology.edges()[order_[place]];
    const bool always = edge.boundary ? parameters.boundaries : parameters.features && edge.isFeature();
    betas_[place] = test.beta(parameters, order_[place]);
    if (edge.nonManifold || (edge.boundary && !always)) continue;
    const CurveOffsets& d = curves[order_[place]];
    float center = 0.0f;
    if (!centers.empty())
      for (const Side& face : edge.faces)
        if (face.triangle != kNone) center = std::max(center, lengthOf(centers[face.triangle]));
    const float sum = lengthOf(d[0] + d[1]), turn = 3.0f * lengthOf(d[0] - d[1]);
    const float chord = 0.5f * PixelMap::kChordFactor * sum + PixelMap::kTurnFactor * turn;
    bulges_[place] = std::max(chord, 0.5f * sum + 0.25f * center);
    cluster.bulge = std::max(cluster.bulge, bulges_[place]);
    if (always && bulges_[place] > 0.0f) cluster.always |= std::uint64_t{1} << i;
  }
}

// Bounding sphere of its vertices, and the cone of their normals and of their faces'.
void EdgeClusters::boundCluster(std::size_t c, const Mesh& mesh, const EdgeTest& test) {
  Cluster& cluster = clusters_[c];
  vec3 low(kInfinity), high(-kInfinity), sum(0.0f);
  for (std::size_t i = cluster.firstVertex; i < cluster.firstVertex + cluster.paddedCount; ++i) {
    const vec3 &p = mesh.positions[vertices_[i]], &n = mesh.normals[vertices_[i]];
    low = glm::min(low, p);
    high = glm::max(high, p);
    if (i < cluster.firstVertex + cluster.vertexCount) sum += n;
    x_[i] = p.x;
    y_[i] = p.y;
    z_[i] = p.z;
    nx_[i] = n.x;
    ny_[i] = n.y;
    nz_[i] = n.z;
  }
  cluster.cone.begin(low, high, sum);
  for (std::size_t i = cluster.firstVertex; i < cluster.firstVertex + cluster.vertexCount; ++i)
    cluster.cone.include(mesh.normals[vertices_[i]]);
  for (std::size_t place = c * kEdgesPerCluster; place < std::min((c + 1) * kEdgesPerCluster, order_.size());
       ++place)
    for (const Side& face : topology_->edges()[order_[place]].faces)
      if (face.triangle != kNone) cluster.cone.include(test.faceNormals()[face.triangle]);
  cluster.cone.finish();
}

EdgeClusters::Eye::Eye(const View& from, const Parameters& parameters, float largestBeta)
    : view(from),
      perspective(from.projection.perspective),
      silhouetteness(parameters.silhouetteness),
      tolerance(parameters.segments > 0 ? 0.0f : parameters.tolerance),
      beta(largestBeta),
      scale(from) {}

// Whether α = 0 for every edge of the cluster.
bool EdgeClusters::facesAway(const Cluster& cluster, const Eye& eye) const {
  const FacingBound facings = cluster.cone.facings(eye.view);
  if (!(facings.least > 0.0f)) return false;
  if (eye.silhouetteness == Silhouetteness::kCrossing) return facings.least > eye.beta * facings.spread;
  return facings.least * facings.least > eye.beta;
}

std::uint64_t EdgeClusters::classify(std::size_t c, const Eye& eye, const EdgeTest& test,
                                     std::span<float> alphas, float& scale) const {
  const Cluster& cluster = clusters_[c];
  if (cluster.bulge == 0.0f) return 0;
  scale = eye.scale.within(cluster.cone.center, cluster.cone.radius + cluster.bulge);
  const float threshold = eye.tolerance / scale;
  if (cluster.bulge <= threshold) return 0;
  if (cluster.always == 0 && facesAway(cluster, eye)) return 0;

  std::uint64_t bends = 0;
  const std::size_t begin = c * kEdgesPerCluster, end = std::min(begin + kEdgesPerCluster, order_.size());
  if (eye.silhouetteness == Silhouetteness::kEdge) {
    for (std::size_t place = begin; place < end; ++place) {
      if (!(bulges_[place] > threshold) || (cluster.always >> (place - begin) & 1) != 0) continue;
      const float f = test.byEdge(eye.view, topology_->edges()[order_[place]]);
      const float alpha = alphas[place - begin] = silhouettenessOf(f, betas_[place]);
      if (alpha * bulges_[place] > threshold) bends |= std::uint64_t{1} << (place - begin);
    }
  } else {
    const std::size_t first = cluster.firstVertex;
    std::array<float, 6 * kEdgesPerCluster> facings;  // at most six vertices per edge
    computeFacings(eye.perspective ? eye.view.eye : -eye.view.direction, eye.perspective,
                   {&x_[first], &y_[first], &z_[first], &nx_[first], &ny_[first], &nz_[first]},
                   cluster.paddedCount, facings.data());
    bends = computeAlphas(
        {&corners_[6 * begin], facings.data(), cluster.vertexCount, &betas_[begin], &bulges_[begin]},
        eye.silhouetteness == Silhouetteness::kCrossing, threshold, alphas.data());
  }
  for (std::uint64_t rest = cluster.always; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    alphas[i] = 1.0f;
    if (bulges_[begin + i] > threshold) bends |= std::uint64_t{1} << i;
  }
  return bends;
}

}  // namespace limn::silhouette
