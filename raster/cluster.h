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
  std::uint32_t firstVertex = 0;    ///< into ClusterSet::vertices
  std::uint32_t firstTriangle = 0;  ///< into ClusterSet::triangles and corners
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
  std::vector<std::uint32_t> triangles;              ///< per triangle: its number in the order of submission
  ClusterVertices points;
  std::vector<ClusterBounds> bounds;

  std::size_t memoryBytes() const;
  bool isConsistent() const;
};

/// Kernels read whole vectors: arrays are this much longer than their contents.
inline constexpr std::size_t kPadding = 64;

/// Appends triangles to a ClusterSet (all but its points and bounds), a new cluster whenever one is full.
class ClusterCutter {
 public:
  /// Empties the set; its memory stays.
  explicit ClusterCutter(ClusterSet& set);
  void add(const std::uint32_t* corners, std::uint32_t triangle, std::uint32_t material);
  void finish();  ///< after the last triangle

 private:
  static constexpr std::uint32_t kSlots = 256;  // of a hash table that never holds more than kClusterVertices
  struct Slot {
    std::uint32_t cluster, vertex, local;
  };
  Slot& slotOf(std::uint32_t vertex);
  bool holds(const Slot& slot) const { return slot.cluster == set_.clusters.size(); }
  bool fits(const std::uint32_t* corners);

  ClusterSet& set_;
  std::array<Slot, kSlots> slots_{};
};

/// The bounding sphere of a cluster's points.
ClusterBounds boundPoints(const Cluster& cluster, const ClusterVertices& points);
/// The bounding sphere and the cone of the face normals.
ClusterBounds boundTriangles(const ClusterSet& set, const Cluster& cluster);

/// The mesh as Geometry keeps it.
struct Geometry::Data {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec4> colors, tangents;
  std::vector<Part> parts;
  std::vector<std::uint32_t> partOfTriangle;  ///< empty where there is one part
  std::size_t triangleCount = 0;
  ClusterSet set;
};

}  // namespace limn::raster
