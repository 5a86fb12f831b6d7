// One view's refinement by blended patches: what its steps work on and hand to each other.
//
// patches_edges.cpp finds the edges that bend, patches_cuts.cpp decides how triangles are cut, patches_stream.cpp writes
// the stream. Every edge has one record with its α, curve and segments, from which both its triangles take the same points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/bare_test.h"
#include "silhouette/chord_kernel.h"
#include "silhouette/edge_clusters.h"
#include "silhouette/patch.h"
#include "silhouette/pattern.h"
#include "silhouette/smooth_edge.h"
#include "silhouette/view_pass.h"

namespace limn::silhouette {

/// All that it refers to outlives it.
struct PatchesPass : ViewPass {
  static constexpr std::size_t kWordsPerBlock = 64;  ///< of 64 triangles each

  /// What a block of triangles adds to the stream.
  struct Share {
    std::size_t curved = 0;
    StreamSize size;

    Share& operator+=(const Share& other) {
      curved += other.curved;
      size.vertices += other.size.vertices;
      size.triangles += other.size.triangles;
      return *this;
    }
  };

  /// Memory that is kept from view to view.
  struct Scratch {
    std::vector<std::uint32_t> blockCounts;  // smooth edges per block of clusters, then their prefix sums
    std::vector<std::uint64_t> masks;        // per cluster: the edges that bend
    std::vector<float> alphas;               // per place in the clusters' order, where an edge bends
    std::vector<float> scales;               // per cluster, where an edge bends
    std::vector<SmoothEdge> smooth;          // the first stands for all edges that do not bend
    std::vector<std::uint32_t> recordOf;     // per edge: index into smooth
    std::vector<std::uint64_t> candidates;   // bit per triangle: has a smooth edge
    std::vector<std::uint32_t> firstCut;     // per word of candidates: index into cuts, and their number
    std::vector<Pattern> cuts;               // per candidate, in order
    std::vector<Share> shares;               // per block of triangles, then prefix sums
  };

  const EdgeTest& test;
  const EdgeClusters& clusters;
  const std::vector<CurveOffsets>& curves;
  const std::vector<glm::vec3>& centers;  // of fitted patches; empty without
  Scratch& scratch;

  void run();

 private:
  struct BentTriangle {
    std::array<BentSide, 3> sides;
    float scale = 0;  // pixels that a unit of the model measures at most near it
    glm::vec3 fittedCenter{0.0f};
    bool wholeFromContour = false;
  };

  void forgetRecords();

  // patches_edges.cpp
  void classify();
  void measureEdges();
  void describe(std::size_t cluster, std::uint32_t record, CurveBatch& batch);
  void setSegments(const CurveBatch& batch, std::uint32_t record);

  // patches_cuts.cpp
  void listCandidates();
  void place();
  Share decide(std::size_t word);
  Pattern patternOf(std::size_t triangle, const Records& records) const;
  BentTriangle bentTriangleOf(std::size_t triangle, const Records& records) const;
  bool passesBare(std::size_t triangle, const BentTriangle& bent, const Pattern& pattern) const;
  std::uint32_t gridSteps(std::size_t triangle, const BentTriangle& bent) const;
  bool isWithin(float limit, const glm::vec3& apart, float scale, std::size_t triangle,
                const std::array<float, 3>& weights) const;
  float distanceAt(std::size_t triangle, const std::array<float, 3>& weights, const glm::vec3& apart) const;

  // patches_stream.cpp
  void emit();
  void emitEdge(const SmoothEdge& smooth);
  void emitTriangle(std::uint32_t triangle, const Pattern& pattern, std::uint32_t& vertex,
                    std::uint32_t& face);
  void emitBare(std::uint32_t triangle, const Records& records, const Pattern& pattern, std::uint32_t& face);
  SidePoints sidePointsOf(std::uint32_t side, const SmoothEdge& smooth) const;
  Patch patchOf(std::size_t triangle, const Records& records) const;

  Records recordsOf(std::size_t triangle) const {
    const std::uint32_t* edge = &topology.sideEdges()[3 * triangle];
    const SmoothEdge* smooth = scratch.smooth.data();
    return {smooth + scratch.recordOf[edge[0]], smooth + scratch.recordOf[edge[1]],
            smooth + scratch.recordOf[edge[2]]};
  }
};

}  // namespace limn::silhouette
