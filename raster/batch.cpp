#include "raster/batch.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "raster/numbers.h"

namespace limn::raster {
namespace {

constexpr std::size_t kStreamPiece = 2048;  // triangles of a stream that one batch holds
constexpr std::size_t kPoseGrain = 4096;

// Rows of the matrix that turns normals: the cofactors, with the sign that keeps the outside outside. Only directions
// count, so a power of two takes the scale away: products of huge or tiny ones would leave the floats when squared.
void setNormalRows(const glm::mat3& scaled, float sign, Batch& batch) {
  float largest = 0.0F;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::fabs(scaled[i][j]));
  int exponent = 0;
  std::frexp(largest, &exponent);
  const glm::mat3 m = scaled * std::ldexp(1.0F, -exponent);
  const glm::vec3 rows[3] = {
      {m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}};
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 &a = rows[(i + 1) % 3], &b = rows[(i + 2) % 3];
    batch.normalRows[i][0] = sign * (a.y * b.z - a.z * b.y);
    batch.normalRows[i][1] = sign * (a.z * b.x - a.x * b.z);
    batch.normalRows[i][2] = sign * (a.x * b.y - a.y * b.x);
  }
}

// An upper bound of the largest singular value: the square root of the largest row sum of |MᵀM|.
float stretchOf(const glm::mat3& m) {
  float largest = 0.0F;
  for (int i = 0; i < 3; ++i) {
    float sum = 0.0F;
    for (int j = 0; j < 3; ++j) {
      const glm::vec3 &a = m[i], &b = m[j];
      sum += std::fabs((a.x * b.x + a.y * b.y) + a.z * b.z);
    }
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest) * 1.00001F;
}

void setTransform(const glm::mat4& modelToView, bool perspective, Batch& batch) {
  const glm::mat3 m(modelToView);
  batch.toView = Affine(modelToView);
  const glm::vec3 c{m[1].y * m[2].z - m[1].z * m[2].y, m[1].z * m[2].x - m[1].x * m[2].z,
                    m[1].x * m[2].y - m[1].y * m[2].x};
  const float determinant = (m[0].x * c.x + m[0].y * c.y) + m[0].z * c.z;
  batch.mirrored = determinant < 0.0F;
  setNormalRows(m, batch.mirrored ? -1.0F : 1.0F, batch);
  batch.stretch = stretchOf(m);
  batch.conesHold = false;
  if (determinant == 0.0F || !std::isfinite(determinant)) return;
  const glm::mat3 inverse = glm::inverse(m);
  batch.eye = perspective ? inverse * -glm::vec3(modelToView[3]) : inverse * glm::vec3(0.0F, 0.0F, 1.0F);
  batch.conesHold = isFinite(batch.eye);
}

// The vertices of a draw, as they are this frame: the geometry's, then the stream's.
class DrawnVertices {
 public:
  explicit DrawnVertices(const Draw& draw)
      : count_(draw.geometry->vertexCount()),
        positions_(orElse(draw.posedPositions, draw.geometry->data().vertices.positions)),
        normals_(orElse(draw.posedNormals, draw.geometry->data().vertices.normals)),
        stream_(draw.stream.vertices) {}

  /// The points of a set's vertices [begin, end).
  void copy(const ClusterSet& set, std::size_t begin, std::size_t end, ClusterVertices& points) const {
    float* out[6] = {points.x.data(),  points.y.data(),  points.z.data(),
                     points.nx.data(), points.ny.data(), points.nz.data()};
    for (std::size_t i = begin; i < end; ++i) {
      // Chosen without a branch: a cluster of a stream mixes the two.
      const std::size_t v = set.vertices[i];
      const bool isOwn = v >= count_;
      const std::size_t at = v - (isOwn ? count_ : 0);
      const glm::vec3& p = (isOwn ? stream_.positions.data() : positions_)[at];
      const glm::vec3& n = (isOwn ? stream_.normals.data() : normals_)[at];
      out[0][i] = p.x, out[1][i] = p.y, out[2][i] = p.z;
      out[3][i] = n.x, out[4][i] = n.y, out[5][i] = n.z;
    }
  }

 private:
  static const glm::vec3* orElse(std::span<const glm::vec3> posed, std::span<const glm::vec3> otherwise) {
    return posed.empty() ? otherwise.data() : posed.data();
  }

  std::size_t count_;
  const glm::vec3 *positions_, *normals_;
  const Vertices& stream_;
};

// Clusters of the stream's triangles [first, last). They have no cones: to find those costs more than to cull the
// triangles that face away.
void cutStream(const Draw& draw, std::size_t first, std::size_t last, VertexNumbers& numbers,
               ClusterSet& set) {
  const Geometry::Data& geometry = draw.geometry->data();
  ClusterCutter cutter(set, last - first, numbers);
  const std::span<const std::uint32_t> sources = draw.stream.sourceTriangles;
  for (std::size_t t = first, end = first; t < last; t = end) {
    const std::uint32_t part = geometry.partOfTriangle.empty() ? 0 : geometry.partOfTriangle[sources[t]];
    const std::uint32_t behind = geometry.parts[part].firstTriangle + geometry.parts[part].triangleCount;
    end = static_cast<std::size_t>(std::lower_bound(sources.begin() + static_cast<std::ptrdiff_t>(t),
                                                    sources.begin() + static_cast<std::ptrdiff_t>(last),
                                                    behind) -
                                   sources.begin());
    cutter.add(draw.stream.indices.subspan(3 * t, 3 * (end - t)), geometry.parts[part].material);
  }
  cutter.finish();
  set.points.resize(set.vertices.size());
  DrawnVertices(draw).copy(set, 0, set.vertices.size(), set.points);
  set.bounds.clear();
  for (const Cluster& cluster : set.clusters) set.bounds.push_back(boundPoints(cluster, set.points));
}

}  // namespace

std::uint64_t Batch::order(std::uint32_t triangleOfSet) const {
  // Within a draw: the geometry's triangles first, then the stream's.
  const std::uint64_t within =
      (isStream ? draw->geometry->triangleCount() : 0) + firstTriangle + triangleOfSet;
  return (static_cast<std::uint64_t>(drawIndex) << 32) | within;
}

bool Batch::isReplaced(const Cluster& cluster) const {
  if (isStream || draw->replaced.empty()) return false;
  const std::uint32_t first = cluster.firstTriangle, last = first + cluster.triangleCount;
  for (std::uint32_t t = first; t < last; t = (t / 64 + 1) * 64) {
    const std::uint64_t from = ~std::uint64_t{0} << (t % 64);
    const std::uint64_t to = last - t / 64 * 64 >= 64 ? 0 : ~std::uint64_t{0} << (last % 64);
    if ((~draw->replaced[t / 64] & from & ~to) != 0) return false;
  }
  return true;
}

void BatchBuilder::pose(const Draw& draw, Posed& posed, Workers& workers) const {
  const ClusterSet& set = draw.geometry->data().set;
  posed.points.resize(set.vertices.size());
  posed.bounds.resize(set.clusters.size());
  workers.forBlocks(set.vertices.size(), kPoseGrain, [&](std::size_t begin, std::size_t end, int) {
    DrawnVertices(draw).copy(set, begin, end, posed.points);
  });
  workers.forBlocks(set.clusters.size(), kPoseGrain / kClusterVertices,
                    [&](std::size_t begin, std::size_t end, int) {
                      for (std::size_t i = begin; i < end; ++i)
                        posed.bounds[i] = boundPoints(set.clusters[i], posed.points);
                    });
}

void BatchBuilder::cutStreams(const Frame& frame, Workers& workers) {
  std::size_t vertices = 0;
  for (const Draw& draw : frame.draws)
    if (!draw.stream.indices.empty())
      vertices = std::max(vertices, draw.geometry->vertexCount() + draw.stream.vertices.positions.size());
  numbers_.resize(static_cast<std::size_t>(workers.threads()));
  for (VertexNumbers& numbers : numbers_) numbers.reserve(vertices);
  workers.forBlocks(batches_.size(), 1, [&](std::size_t begin, std::size_t, int slot) {
    Batch& batch = batches_[begin];
    if (!batch.isStream) return;
    const std::size_t count = batch.draw->stream.sourceTriangles.size();
    ClusterSet& set = *sets_[batch.streamSet];
    cutStream(*batch.draw, batch.firstTriangle, std::min(count, batch.firstTriangle + kStreamPiece),
              numbers_[static_cast<std::size_t>(slot)], set);
    batch.points = &set.points, batch.bounds = set.bounds.data();
  });
}

std::span<const Batch> BatchBuilder::build(const Frame& frame, const ScreenMap& map, Workers& workers) {
  batches_.clear();
  std::size_t posedCount = 0, setCount = 0;
  for (std::uint32_t i = 0; i < frame.draws.size(); ++i) {
    const Draw& draw = frame.draws[i];
    Batch batch;
    batch.draw = &draw;
    batch.drawIndex = i;
    setTransform(draw.modelToView, map.perspective, batch);
    const Geometry::Data& geometry = draw.geometry->data();
    if (!draw.posedPositions.empty() || !draw.posedNormals.empty()) {
      if (posedCount == posed_.size()) posed_.push_back(std::make_unique<Posed>());
      Posed& posed = *posed_[posedCount++];
      pose(draw, posed, workers);
      batch.set = &geometry.set, batch.points = &posed.points, batch.bounds = posed.bounds.data();
    } else {
      batch.set = &geometry.set, batch.points = &geometry.set.points,
      batch.bounds = geometry.set.bounds.data();
    }
    if (!geometry.set.clusters.empty()) batches_.push_back(batch);
    batch.isStream = true;
    for (std::size_t t = 0; t < draw.stream.sourceTriangles.size(); t += kStreamPiece) {
      if (setCount == sets_.size()) sets_.push_back(std::make_unique<ClusterSet>());
      batch.streamSet = setCount;
      batch.set = sets_[setCount++].get();
      batch.firstTriangle = static_cast<std::uint32_t>(t);
      batches_.push_back(batch);
    }
  }
  cutStreams(frame, workers);
  clusterCount_ = 0;
  for (Batch& batch : batches_) {
    batch.firstCluster = clusterCount_;
    clusterCount_ += batch.set->clusters.size();
  }
  return batches_;
}

std::size_t BatchBuilder::memoryBytes() const {
  std::size_t bytes = batches_.capacity() * sizeof(Batch);
  for (const auto& p : posed_)
    bytes += p->points.memoryBytes() + p->bounds.capacity() * sizeof(ClusterBounds);
  for (const auto& s : sets_) bytes += s->memoryBytes();
  for (const VertexNumbers& n : numbers_) bytes += n.memoryBytes();
  return bytes;
}

}  // namespace limn::raster
