#include "raster/cluster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raster/numbers.h"

namespace limn::raster {
namespace {

// Of points that are not all finite, or too far apart: triangles are looked at one by one.
constexpr ClusterBounds kUnbounded{.radius = std::numeric_limits<float>::infinity()};

glm::vec3 point(const ClusterVertices& v, std::size_t i) {
  return {v.x[i], v.y[i], v.z[i]};
}

}  // namespace

void ClusterVertices::resize(std::size_t count) {
  for (auto* a : {&x, &y, &z, &nx, &ny, &nz}) a->resize(count + kPadding, 0.0F);
}

void ClusterVertices::set(std::size_t i, const glm::vec3& position, const glm::vec3& normal) {
  x[i] = position.x, y[i] = position.y, z[i] = position.z;
  nx[i] = normal.x, ny[i] = normal.y, nz[i] = normal.z;
}

std::size_t ClusterSet::memoryBytes() const {
  return clusters.capacity() * sizeof(Cluster) + vertices.capacity() * sizeof vertices[0] +
         3 * corners[0].capacity() + points.memoryBytes() + bounds.capacity() * sizeof(ClusterBounds);
}

bool ClusterSet::isConsistent() const {
  std::size_t nextVertex = 0, nextTriangle = 0;
  for (const Cluster& c : clusters) {
    if (c.firstVertex != nextVertex || c.firstTriangle != nextTriangle) return false;
    if (c.vertexCount < 1 || c.vertexCount > kClusterVertices) return false;
    if (c.triangleCount < 1 || c.triangleCount > kClusterTriangles) return false;
    nextVertex += c.vertexCount;
    nextTriangle += c.triangleCount;
    for (std::size_t t = c.firstTriangle; t < nextTriangle; ++t)
      for (const auto& corner : corners)
        if (corner[t] >= c.vertexCount) return false;
  }
  return nextVertex == vertices.size() && nextTriangle + kPadding == corners[0].size();
}

void VertexNumbers::beginCluster() {
  if (++cluster_ < kClusters) return;
  std::fill(words_.begin(), words_.end(), 0);
  cluster_ = 1;
}

ClusterCutter::ClusterCutter(ClusterSet& set, std::size_t triangles, VertexNumbers& numbers)
    : set_(set), numbers_(numbers) {
  set.clusters.clear();
  for (auto& corner : set.corners) corner.resize(triangles + kPadding);
}

// How many vertices a triangle would add to the cluster.
std::uint32_t ClusterCutter::freshOf(const std::uint32_t* c) const {
  std::uint32_t fresh = numbers_.has(c[0]) ? 0 : 1;
  fresh += !numbers_.has(c[1]) && c[1] != c[0] ? 1 : 0;
  return fresh + (!numbers_.has(c[2]) && c[2] != c[0] && c[2] != c[1] ? 1 : 0);
}

bool ClusterCutter::hasRoomFor(const std::uint32_t* corners, std::uint32_t material) const {
  if (cluster_.triangleCount == 0 || cluster_.material != material ||
      cluster_.triangleCount == kClusterTriangles)
    return false;
  return cluster_.vertexCount + 3U <= kClusterVertices ||
         cluster_.vertexCount + freshOf(corners) <= kClusterVertices;
}

void ClusterCutter::begin(std::uint32_t material) {
  if (cluster_.triangleCount > 0) set_.clusters.push_back(cluster_);
  numbers_.beginCluster();
  cluster_ = {cluster_.firstVertex + cluster_.vertexCount, static_cast<std::uint32_t>(next_), 0, 0, material};
  // One more, for add() writes a vertex before it knows whether it is a fresh one.
  const std::size_t wanted = std::size_t{cluster_.firstVertex} + kClusterVertices + 1;
  if (set_.vertices.size() < wanted) set_.vertices.resize(std::max(wanted, set_.vertices.capacity()));
}

void ClusterCutter::add(std::span<const std::uint32_t> indices, std::uint32_t material) {
  for (std::size_t i = 0; i < indices.size();) {
    if (!hasRoomFor(&indices[i], material)) begin(material);
    // So many fit whatever vertices they have, and one does at least.
    const std::uint32_t room = static_cast<std::uint32_t>(kClusterVertices - cluster_.vertexCount) / 3U;
    const std::uint32_t count = std::min(std::max(room, 1U), kClusterTriangles - cluster_.triangleCount + 0U);
    const auto left = static_cast<std::uint32_t>((indices.size() - i) / 3);
    fill(&indices[i], std::min(count, left));
    i += 3 * std::size_t{std::min(count, left)};
  }
}

// Adds triangles that fit.
void ClusterCutter::fill(const std::uint32_t* corners, std::uint32_t count) {
  // All in locals: bytes are stored, which may alias any member.
  const VertexNumbers::Words words = numbers_.words();
  std::uint32_t* vertices = &set_.vertices[cluster_.firstVertex];
  std::uint8_t* numbers[3] = {&set_.corners[0][next_], &set_.corners[1][next_], &set_.corners[2][next_]};
  std::uint32_t fresh = cluster_.vertexCount;
  for (std::uint32_t t = 0; t < count; ++t, corners += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t number = words.number(corners[k], fresh);
      vertices[fresh] = corners[k];
      numbers[k][t] = static_cast<std::uint8_t>(number);
      fresh += number == fresh ? 1U : 0U;
    }
  }
  cluster_.vertexCount = static_cast<std::uint16_t>(fresh);
  cluster_.triangleCount = static_cast<std::uint16_t>(cluster_.triangleCount + count);
  next_ += count;
}

void ClusterCutter::finish() {
  if (cluster_.triangleCount > 0) set_.clusters.push_back(cluster_);
  set_.vertices.resize(std::size_t{cluster_.firstVertex} + cluster_.vertexCount);
}

ClusterBounds boundPoints(const Cluster& cluster, const ClusterVertices& v) {
  glm::vec3 low = point(v, cluster.firstVertex), high = low;
  for (std::uint32_t i = 1; i < cluster.vertexCount; ++i) {
    const glm::vec3 p = point(v, cluster.firstVertex + i);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  ClusterBounds bounds;
  bounds.center = low + (high - low) * 0.5F;
  float square = 0.0F, sum = 0.0F;
  for (std::uint32_t i = 0; i < cluster.vertexCount; ++i) {
    const glm::vec3 d = point(v, cluster.firstVertex + i) - bounds.center;
    square = std::max(square, dot(d, d));
    sum += dot(d, d);
  }
  if (!std::isfinite(sum)) return kUnbounded;
  bounds.radius = std::sqrt(square) * 1.00001F;
  return bounds;
}

ClusterBounds boundTriangles(const ClusterSet& set, const Cluster& cluster) {
  const ClusterVertices& v = set.points;
  ClusterBounds bounds = boundPoints(cluster, v);
  std::array<glm::vec3, kClusterTriangles> normals;
  std::size_t count = 0;
  glm::vec3 sum(0.0F);
  for (std::uint32_t t = cluster.firstTriangle; t < cluster.firstTriangle + cluster.triangleCount; ++t) {
    const glm::vec3 a = point(v, cluster.firstVertex + set.corners[0][t]);
    const glm::vec3 e = point(v, cluster.firstVertex + set.corners[1][t]) - a;
    const glm::vec3 f = point(v, cluster.firstVertex + set.corners[2][t]) - a;
    const glm::vec3 n{e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
    const float length = std::sqrt(dot(n, n));
    // A triangle without a reliable normal may face anywhere, so its cluster is never culled.
    if (!(length > 1e-6F * std::sqrt(dot(e, e) * dot(f, f)))) return bounds;
    normals[count] = n * (1.0F / length);
    sum += normals[count++];
  }
  const float length = std::sqrt(dot(sum, sum));
  if (!(length > 0.0F)) return bounds;
  bounds.coneAxis = sum * (1.0F / length);
  float cosine = 1.0F;
  for (std::size_t i = 0; i < count; ++i) cosine = std::min(cosine, dot(normals[i], bounds.coneAxis));
  if (cosine > 0.1F) bounds.coneSine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
  return bounds;
}

}  // namespace limn::raster
