// What silhouette curves know of a mesh from every viewpoint.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/blocking.h"
#include "silhouette/edge_curves.h"
#include "silhouette/facing_kernel.h"
#include "silhouette/method.h"
#include "silhouette/normal_cone.h"
#include "silhouette/robust_ends.h"

namespace limn::silhouette {

/// Points and normals in structure-of-arrays form.
class PointNormals {
 public:
  void resize(std::size_t count) { numbers_.resize(6 * (count_ = count)); }
  void set(std::size_t i, const glm::vec3& p, const glm::vec3& n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      numbers_[axis * count_ + i] = p[static_cast<int>(axis)];
      numbers_[(3 + axis) * count_ + i] = n[static_cast<int>(axis)];
    }
  }
  VertexArrays arrays() const {
    const float* x = numbers_.data();
    return {x, x + count_, x + 2 * count_, x + 3 * count_, x + 4 * count_, x + 5 * count_};
  }

 private:
  std::vector<float> numbers_;
  std::size_t count_ = 0;
};

/// What is looked at of every edge in every view.
struct EdgeLink {
  std::array<std::uint32_t, 2> faces{};  ///< the one twice on a boundary
  std::array<std::uint32_t, 2> ends{};   ///< vertices of faces[0]
  float bend = 0;        ///< smooth, with a curve (ring.h): at most so far from its chord, in model units
  bool always = false;   ///< sampled from every viewpoint
  bool bridged = false;  ///< may have silhouette points
  bool seam = false;     ///< the faces have vertices of their own
};

/// A run of edges, passed over together where none of them matters.
struct EdgeRun {
  static constexpr std::size_t kEdges = 64;

  NormalCone cone;      ///< around the ends and the normals at them and of the faces
  float bend = 0;       ///< the largest
  bool always = false;  ///< one at least is
};

/// How far a bridge is believed (robust_ends.h), 0 … 1: at its ends as the edges at each vertex are on average, so that
/// nothing jumps where the contour passes over a vertex from one edge to the next; in between as its own ends.
struct BridgeTrust {
  std::array<float, 2> ends{1.0f, 1.0f};
  float middle = 1;  ///< the mean of its own

  float at(float t) const {
    const float s = 1.0f - t;
    return s * s * ends[0] + 2.0f * s * t * middle + t * t * ends[1];
  }
  bool isNone() const { return ends[0] == 0.0f && ends[1] == 0.0f && middle == 0.0f; }
};

struct CurveSet {
  std::vector<EdgeVertices> vertices;  ///< of every edge
  std::vector<EdgeLink> links;         ///< likewise
  std::vector<EdgeRun> runs;           ///< edges 0 … 63, 64 … 127 and so on
  PointNormals corners;                ///< of the mesh's vertices
  PointNormals planes;                 ///< of its triangles: a corner, the unit normal
  glm::vec3 middle{0.0f};              ///< of the mesh, and how far it reaches from there
  float radius = 0;                    ///< with room for the curves' control points
  float largestBend = 0;
  std::vector<CurveOffsets> curves;    ///< bridges and feature curves; zero where an edge stays straight
  std::vector<BridgeTrust> trust;      ///< of every edge
  std::vector<glm::vec3> faceNormals;  ///< unit; zero for degenerate triangles
  std::vector<glm::vec3> centers;      ///< what fitted patches add to b111; empty without
  Blocking blocking;

  /// The first edge of a run, or the number of edges.
  std::size_t firstOfRun(std::size_t r) const { return std::min(r * EdgeRun::kEdges, links.size()); }

  /// From the mesh alone, or with fitted curves, which are believed.
  void prepare(const Mesh& mesh, const Topology& topology, const FittedCurves& fitted,
               const Parameters& parameters, const Crew& crew);

  /// Gives back the memory that only prepare() needs; a later one allocates it anew.
  void dropScaffold();

 private:
  void linkEdge(std::size_t e, const Mesh& mesh, const Topology& topology, const Parameters& parameters);
  float facingOf(std::size_t e, const Mesh& mesh, const Edge& edge) const;
  void trustBridges(const Topology& topology, const Crew& crew);
  float trustAround(std::size_t point, const Topology& topology) const;
  bool isBelievedAround(std::size_t e, const Topology& topology) const;
  void boundRun(std::size_t r, const Mesh& mesh);
  void spread(const Mesh& mesh, const Crew& crew);

  RobustEnds robust_;
  std::vector<std::array<float, 2>> ownTrust_;  // per edge
  std::vector<float> pointTrust_;
};

}  // namespace limn::silhouette
