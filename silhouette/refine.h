// The refined triangle stream of a mesh for one viewpoint, by any of the methods.
//
//   limn::silhouette::Topology topology(mesh);                    // once, or once per change of the indices
//   limn::silhouette::Refiner refiner(mesh, topology, workers);   // keeps what does not change from view to view
//   refiner.refine(view, parameters, stream);                     // per frame
//   refiner.deform(mesh);                                         // when positions and normals have changed
//   refineAll(tasks, parameters, workers);                        // per frame, many instances at once
//
// The view maps the mesh's own space to pixels, so instances of one mesh that differ by a similarity
// (rotation, uniform scale, reflection, translation) share one Refiner: one topology, one set of edge curves,
// a view and a stream each. Tangent planes and angles do not survive a non-uniform scale: pose such an
// instance into world space (positions by the matrix, normals by its inverse transpose; a reflection must
// also exchange two indices of every triangle), give it a Refiner of its own and call deform() when it changes its
// shape.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "raster/base/workers.h"
#include "silhouette/fitted_curves.h"
#include "silhouette/mesh.h"
#include "silhouette/topology.h"

namespace limn::silhouette {

enum class Method { kFlat, kPatches, kCurves, kPn };
/// What tells a silhouette edge; silhouetteness.h has the formulas, and the paper that (1) to (3) are of.
enum class Silhouetteness {
  kEdge,     ///< its faces, (1)
  kContour,  ///< the shading normals of its faces' corners
  kCrossing  ///< where the zero set of the shading normals' facing crosses it or its faces; fitted curves take kContour
};
enum class Tangents {
  kProjected,
  kCircular,
  kGeodesic,
  kGeodesicArc  ///< geodesic-like, and as long as a circular arc's: of silhouette curves
};
enum class ShadingNormals { kLinear, kQuadratic };

/// How to refine. The defaults are those of the program.
struct Parameters {
  Method method = Method::kPatches;
  float tolerance = 0.25f;  ///< guaranteed distance in pixels, >= 0; used when segments == 0
  int segments = 0;         ///< fixed count per edge, 1 … kMaxSegments; 0 = from the tolerance
  float beta = 0.1f;        ///< constant β of (2), >= 0; the paper has 0.25
  float wedgeDegrees = 0;   ///< > 0: β per edge from the wedge angle φ, (3)
  /// β of each edge instead of the two above, or empty. Finite, >= 0, in the order of Topology::edges(); borrowed until
  /// refine() returns.
  std::span<const float> edgeBetas;
  Silhouetteness silhouetteness = Silhouetteness::kCrossing;
  Tangents tangents = Tangents::kGeodesic;
  bool robust = true;       ///< doubt normals that ask for implausible curves: robust_ends.h
  bool features = true;     ///< feature edges smooth from every viewpoint
  bool boundaries = false;  ///< boundary edges likewise
  ShadingNormals shadingNormals = ShadingNormals::kLinear;
  bool listContour = false;  ///< fill RefinedStream::contour
  /// Method::kPn by tolerance: TooManyTriangles if each triangle would become more than so many. For meshes of strangers:
  /// a single long edge decides on all triangles.
  std::size_t mostPerTriangle = std::numeric_limits<std::size_t>::max();
};

/// Thrown before a stream grows beyond a limit, and before memory is taken for it. The refiner remains of use.
class TooManyTriangles : public std::runtime_error {
 public:
  enum class Limit {
    kPerTriangle,  ///< Parameters::mostPerTriangle
    kIndices  ///< what 32 bits can number: 2^32 - 2 vertices, the mesh's included, or indices of the stream
  };
  TooManyTriangles(Limit passed, std::uint64_t wanted)
      : std::runtime_error("the refinement takes too many triangles"), limit(passed), triangles(wanted) {}

  Limit limit;
  std::uint64_t triangles;  ///< wanted: kPerTriangle of each triangle, kIndices of the stream
};

inline constexpr int kMaxSegments = 64;  ///< per edge; past it the tolerance is no longer guaranteed

/// Where a new vertex lies on the coarse mesh, for whatever attributes the caller interpolates: the source
/// triangle and the weights of its corners 1 and 2 (corner 0 has the rest). On an edge whose faces share both
/// end vertices one vertex serves both faces; across a seam each face has its own, at the same position bit
/// for bit.
struct Origin {
  std::uint32_t triangle = 0;
  glm::vec2 weights{0.0f};
};

/// A straight piece of the outline as silhouette curves draw it, from vertex to vertex, numbered as in
/// RefinedStream::indices.
struct ContourLine {
  std::uint32_t from = 0, to = 0;
  bool crossesTriangle = false;  ///< of a segment; else of a bridge, which replaces an edge
};

/// Triangles that replace some of the mesh's. Everything that is not replaced is drawn as it is.
struct RefinedStream {
  std::vector<glm::vec3> positions;  ///< of new vertices, model space
  /// Not unit: weighted means of the mesh's, so that shading between new vertices is what it is on the flat
  /// triangle to the last digit; only the direction counts. Never zero.
  std::vector<glm::vec3> normals;
  std::vector<Origin> origins;
  /// Three per triangle. Below mesh.positions.size(): a vertex of the mesh; from there on: a new one.
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> sourceTriangles;  ///< one per triangle, ascending
  std::vector<std::uint64_t> replaced;         ///< bit t % 64 of word t / 64 for triangle t of the mesh
  std::vector<ContourLine> contour;            ///< of Method::kCurves, if Parameters::listContour

  std::size_t triangleCount() const { return indices.size() / 3; }
  bool isReplaced(std::size_t triangle) const {
    return (replaced[triangle / 64] >> (triangle % 64) & 1) != 0;
  }
  /// Nothing is replaced, and no contour listed. New vertices and triangles stay until setCounts().
  void restart(std::size_t meshTriangles);
  /// Room for so many new vertices and triangles, which are then to be written: some hold what was there before.
  void setCounts(std::size_t vertices, std::size_t triangles);
  /// Empty, for a mesh of so many triangles.
  void clear(std::size_t meshTriangles);

  /// Indices in range, order ascending, replaced bits match the source triangles, all numbers finite.
  bool isConsistent(const Mesh& mesh) const;
};

/// Per frame: what the refinement did and saw; for overlays, `limn refine --alpha` and statistics.
struct RefineReport {
  std::size_t curvedTriangles = 0;   ///< of the mesh, replaced
  std::size_t refinedTriangles = 0;  ///< in the stream
  std::size_t smoothEdges = 0;       ///< alpha > 0, and a bulge that may pass the tolerance
  std::size_t cappedEdges = 0;       ///< wanted more than kMaxSegments segments
  double classifyMs = 0, refineMs = 0;
};

struct RefineTask;

class Refiner {
 public:
  /// Borrows mesh arrays, topology and fitted curves for as long as it lives. Patches are drawn with the
  /// fitted curves where there are any, and silhouette curves on those patches; boundary edges are then smooth from every
  /// viewpoint.
  /// Throws std::invalid_argument where the counts of mesh, topology and fitted curves do not agree; that the topology was
  /// made of this mesh is the caller's duty.
  Refiner(const Mesh& mesh, const Topology& topology, Workers& workers, const FittedCurves& fitted = {});
  ~Refiner();
  Refiner(Refiner&&) noexcept;
  Refiner& operator=(Refiner&&) noexcept;

  /// New positions and normals, same counts and indices. What depends on them is computed anew by the next
  /// refine(). Throws std::invalid_argument for other counts; that the indices are the same is the caller's duty.
  void deform(const Mesh& mesh);

  /// Refines for a view. The same bits for any number of threads. Throws std::invalid_argument for parameters
  /// outside their ranges and for a view without pixels or near plane, TooManyTriangles for what that says; the stream then
  /// holds nothing of use. Positions, normals and the numbers of the view are not looked at: mesh.h.
  void refine(const View& view, const Parameters& parameters, RefinedStream& stream,
              RefineReport* report = nullptr);

  /// Silhouetteness α of every edge of the topology, in its order, as refine() sees it; all 0 for methods that have none.
  /// Throws std::invalid_argument as refine().
  void silhouetteness(const View& view, const Parameters& parameters, std::vector<float>& alphas);

 private:
  friend void refineAll(std::span<RefineTask> tasks, const Parameters& parameters, Workers& workers);
  struct State;
  std::unique_ptr<State> state_;
};

/// One instance of a frame.
struct RefineTask {
  Refiner* refiner = nullptr;  ///< several tasks may name the same one
  View view;
  RefinedStream* stream = nullptr;  ///< of this task alone
  RefineReport report;              ///< filled
};

/// Refines all tasks: small meshes side by side, large ones one after the other with all threads. The same
/// bits as one refine() after another. Throws what refine() does, and std::invalid_argument for a task without refiner or
/// stream and where `workers` are not those of the refiners; the streams then hold nothing of use.
void refineAll(std::span<RefineTask> tasks, const Parameters& parameters, Workers& workers);

}  // namespace limn::silhouette
