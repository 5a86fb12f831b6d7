// Finds the edges that bend visibly in a view without looking at all of them.
//
// Based on: normal cones over groups of neighbours, as in L. Shirman, S. Abi-Ezzi, "The cone of normals technique for
// fast processing of curved patches", 1993.
// Differs in: edges, 64 to a cluster in Morton order of their midpoints, one level only. A cluster is passed over
// when its largest bulge projects to less than the tolerance, whatever the silhouetteness, or when all its normals face
// so clearly one way that f > β for all its edges. What is left is tested edge by edge, over the cluster's own vertices
// in structure-of-arrays form.
//
// The per-edge results are those of EdgeTest, bit for bit: facing_kernel.h, alpha_kernel.h.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "silhouette/alpha_kernel.h"
#include "silhouette/edge_curves.h"
#include "silhouette/normal_cone.h"
#include "silhouette/silhouetteness.h"
#include "silhouette/view_scale.h"

namespace limn::silhouette {

class EdgeClusters {
 public:
  /// Orders the edges, once per topology.
  void build(const Mesh& mesh, const Topology& topology);

  /// Bounds for new positions, normals or curves. `centers` are those of fitted patches, or empty.
  void update(const Mesh& mesh, const Topology& topology, const EdgeTest& test,
              std::span<const CurveOffsets> curves, std::span<const glm::vec3> centers,
              const Parameters& parameters, const Crew& crew);

  std::size_t count() const { return clusters_.size(); }
  /// The edge at place i of the order; cluster c has places 64 c and up.
  std::uint32_t edgeAt(std::size_t place) const { return order_[place]; }
  /// The vertices at its ends, as edgeVertices has them for its first face.
  const std::array<std::uint32_t, 2>& endsAt(std::size_t place) const { return ends_[place]; }
  /// Whether its second face has vertices of its own there: bit i for place 64 c + i.
  std::uint64_t seams(std::size_t c) const { return clusters_[c].seams; }

  /// How a view sees space; computed once per view.
  struct Eye {
    Eye(const View& view, const Parameters& parameters, float largestBeta);

    View view;
    bool perspective;
    Silhouetteness silhouetteness;
    float tolerance;  ///< pixels; 0 where segments are fixed: every bend counts
    float beta;       ///< the largest of any edge
    ViewScale scale;
  };
  Eye eyeOf(const View& view, const Parameters& parameters) const { return {view, parameters, largestBeta_}; }

  /// The edges of a cluster that bend visibly: bit i for place 64 c + i, whose α goes to alphas[i] of 64. Where there are
  /// any, `scale` becomes the most pixels that a unit of the model measures near them.
  std::uint64_t classify(std::size_t c, const Eye& eye, const EdgeTest& test, std::span<float> alphas,
                         float& scale) const;

 private:
  struct Cluster {
    NormalCone cone;
    float bulge = 0;           // of its edges, the largest
    std::uint64_t always = 0;  // edges that are smooth from every viewpoint
    std::uint64_t seams = 0;
    // Of vertices_: the last is repeated up to whole vectors.
    std::uint32_t firstVertex = 0, vertexCount = 0, paddedCount = 0;
  };

  void measureEdges(std::size_t c, const Topology& topology, const EdgeTest& test,
                    std::span<const CurveOffsets> curves, std::span<const glm::vec3> centers,
                    const Parameters& parameters);
  void boundCluster(std::size_t c, const Mesh& mesh, const EdgeTest& test);
  bool facesAway(const Cluster& cluster, const Eye& eye) const;

  std::vector<std::uint32_t> order_;
  std::vector<Cluster> clusters_;
  std::vector<std::array<std::uint32_t, 2>> ends_;  // per place
  std::vector<std::uint16_t> corners_;   // as in EdgeBlock, in the cluster's vertices; of a lone face twice
  std::vector<float> betas_, bulges_;    // per place; bulges in model units at α = 1, 0 where never smooth
  std::vector<std::uint32_t> vertices_;  // of all clusters, by cluster
  std::vector<float> x_, y_, z_, nx_, ny_, nz_;  // of those vertices
  const Topology* topology_ = nullptr;
  float largestBeta_ = 0;
};

}  // namespace limn::silhouette
