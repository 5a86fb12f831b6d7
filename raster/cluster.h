// Clusters: pieces of a mesh small enough that a tile's owner transforms and draws them whole, in its own
// cache.
//
// Based on: A. Kapoulkine, meshoptimizer, "meshlets" (bounded vertex and triangle counts, normal cones);
// U. Haar, S. Aaltonen, "GPU-Driven Rendering Pipelines", SIGGRAPH 2015 (culling by cluster).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "raster/raster.h"

namespace limn::raster {

inline constexpr int kClusterVertices = 64;
inline constexpr int kClusterTriangles = 128;

struct Cluster {
  std::uint32_t firstVertex = 0;  ///< into ClusterSet::vertices
  std::uint32_t firstTriangle =
      0;  ///< into ClusterSet::corners: the set's triangles are in the order of submission
  std::uint16_t vertexCount = 0;    ///< 1 … kClusterVertices
  std::uint16_t triangleCount = 0;  ///< 1 … kClusterTriangles
  std::uint32_t material = 0;
};

/// What culling needs of a cluster; model space.
struct ClusterBounds {
  glm::vec3 center{0.0F};
  float radius = 0.0F;
  glm::vec3 coneAxis{0.0F};  ///< all face normals are within the cone around it
  float coneSine = 2.0F;     ///< sine of its half angle; 2: too wide to cull anything
};

/// Vertices in structure-of-arrays form, in the order of ClusterSet::vertices.
struct ClusterVertices {
  std::vector<float> x, y, z, nx, ny, nz;

  void resize(std::size_t count);
  void set(std::size_t i, const glm::vec3& position, const glm::vec3& normal);
  std::size_t memoryBytes() const { return 6 * x.capacity() * sizeof(float); }
};

struct ClusterSet {
  std::vector<Cluster> clusters;
  std::vector<std::uint32_t> vertices;               ///< per cluster vertex: the vertex of the mesh
  std::array<std::vector<std::uint8_t>, 3> corners;  ///< per triangle: vertices of its cluster
  ClusterVertices points;
  std::vector<ClusterBounds> bounds;

  std::size_t memoryBytes() const;
  bool isConsistent() const;
};

/// Kernels read whole vectors: arrays are this much longer than their contents.
inline constexpr std::size_t kPadding = 64;

/// Where vertices are in the cluster that is being filled: a word for each vertex of the mesh, looked up, never hashed
/// nor cleared.
class VertexNumbers {
 public:
  /// For vertices below `count`. Memory only grows.
  void reserve(std::size_t count) {
    if (words_.size() < count) words_.resize(count);
  }
  void beginCluster();
  bool has(std::uint32_t vertex) const { return words_[vertex] / kBase == cluster_; }
  /// The words of the vertices and that of number 0 in the cluster, for loops.
  struct Words {
    std::uint32_t* words;
    std::uint32_t first;

    /// The vertex's number in the cluster, which becomes `fresh` if it has none. No branch: there is no telling which
    /// vertices a triangle shares with those before.
    std::uint32_t number(std::uint32_t vertex, std::uint32_t fresh) const {
      const std::uint32_t distance = words[vertex] ^ first;
      const std::uint32_t number = distance < kBase ? distance : fresh;
      words[vertex] = first | number;
      return number;
    }
  };
  Words words() { return {words_.data(), cluster_ * kBase}; }
  std::size_t memoryBytes() const { return words_.capacity() * sizeof words_[0]; }

 private:
  static constexpr std::uint32_t kBase = 256, kClusters = 1U << 24U;
  static_assert(kClusterVertices <= kBase);

  std::vector<std::uint32_t> words_;  // cluster · kBase + number in it
  std::uint32_t cluster_ = 0;         // counts up; no vertex is in cluster 0
};

/// Fills a ClusterSet (all but its points and bounds), a new cluster whenever one is full.
class ClusterCutter {
 public:
  /// Empties the set; its memory stays. `triangles` are going to be added, of vertices that `numbers` has room for.
  ClusterCutter(ClusterSet& set, std::size_t triangles, VertexNumbers& numbers);
  /// Triangles of three `indices` each, the next ones in the order of submission.
  void add(std::span<const std::uint32_t> indices, std::uint32_t material);
  /// After the last triangle: the set is complete.
  void finish();

 private:
  std::uint32_t freshOf(const std::uint32_t* corners) const;
  bool hasRoomFor(const std::uint32_t* corners, std::uint32_t material) const;
  void begin(std::uint32_t material);
  void fill(const std::uint32_t* corners, std::uint32_t count);

  ClusterSet& set_;
  VertexNumbers& numbers_;
  std::size_t next_ = 0;  // triangle of the set
  Cluster cluster_;       // that is being filled
};

/// The bounding sphere of a cluster's points.
ClusterBounds boundPoints(const Cluster& cluster, const ClusterVertices& points);
/// The bounding sphere and the cone of the face normals.
ClusterBounds boundTriangles(const ClusterSet& set, const Cluster& cluster);

/// The mesh as Geometry keeps it.
struct Geometry::Data {
  Vertices vertices;  ///< the caller's, or `copies`
  struct {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec4> colors, tangents;
  } copies;
  std::vector<Part> parts;
  std::vector<std::uint32_t> partOfTriangle;  ///< empty where there is one part
  std::size_t triangleCount = 0;
  ClusterSet set;
};

}  // namespace limn::raster
