// What a frame draws, as the kernels see it: one batch per draw, and one per piece of a draw's stream.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "raster/base/workers.h"
#include "raster/cluster.h"
#include "raster/view.h"

namespace limn::raster {

/// Clusters that share a transform. All that differs from frame to frame.
struct Batch {
  const ClusterSet* set = nullptr;
  const ClusterVertices* points = nullptr;
  const ClusterBounds* bounds = nullptr;
  const Draw* draw = nullptr;
  std::size_t firstCluster = 0;  ///< clusters of the batches before
  std::uint32_t drawIndex = 0;
  std::uint32_t firstTriangle = 0;  ///< number of the batch's first triangle in the draw's geometry or stream
  std::size_t streamSet = 0;        ///< stream: which of the builder's sets
  bool isStream = false;
  bool mirrored = false;  ///< front faces run clockwise
  Affine toView;
  float normalRows[3][3];  ///< direction of a view-space normal
  float stretch = 1.0F;    ///< no vector gets longer by more than this factor
  glm::vec3 eye{0.0F};     ///< model space; orthographic: the direction towards the viewer
  bool conesHold = false;  ///< clusters may be culled by their cones

  /// Submission number of a cluster's triangle: equal depths are resolved by it.
  std::uint64_t order(std::uint32_t triangleOfSet) const;
  /// The geometry's triangle that a triangle is, or replaces.
  std::uint32_t source(std::uint32_t triangleOfSet) const {
    return isStream ? draw->stream.sourceTriangles[firstTriangle + triangleOfSet] : triangleOfSet;
  }
  // A geometry's clusters hold its triangles in the order of submission, so numbers in the set are those of `replaced`.

  /// Bit i: triangle `triangleOfSet` + i of a geometry with replaced triangles is one of them; 16 bits are known.
  std::uint32_t replacedFrom(std::uint32_t triangleOfSet) const {
    const std::size_t t = triangleOfSet;
    std::uint64_t bits = draw->replaced[t / 64] >> (t % 64);
    if (t % 64 > 48 && t / 64 + 1 < draw->replaced.size())
      bits |= draw->replaced[t / 64 + 1] << (64 - t % 64);
    return static_cast<std::uint32_t>(bits);
  }
  /// All of a cluster's triangles are replaced.
  bool isReplaced(const Cluster& cluster) const;
  bool isReplaced(std::uint32_t triangleOfSet) const {
    if (isStream || draw->replaced.empty()) return false;
    return ((draw->replaced[triangleOfSet / 64] >> (triangleOfSet % 64)) & 1U) != 0;
  }
};

/// Makes the batches of a frame; keeps the memory of posed and streamed clusters between frames.
class BatchBuilder {
 public:
  /// Clusters, points and bounds are made in parallel. Batches are in the order of draws, a draw's stream
  /// after it.
  std::span<const Batch> build(const Frame& frame, const ScreenMap& map, Workers& workers);
  std::size_t clusterCount() const { return clusterCount_; }
  std::size_t memoryBytes() const;

 private:
  struct Posed {
    ClusterVertices points;
    std::vector<ClusterBounds> bounds;
  };
  void pose(const Draw& draw, Posed& posed, Workers& workers) const;
  void cutStreams(const Frame& frame, Workers& workers);

  std::vector<Batch> batches_;
  std::vector<std::unique_ptr<Posed>> posed_;      // one per posed draw
  std::vector<std::unique_ptr<ClusterSet>> sets_;  // one per piece of a stream
  std::vector<VertexNumbers> numbers_;             // one per thread
  std::size_t clusterCount_ = 0;
};

}  // namespace limn::raster
