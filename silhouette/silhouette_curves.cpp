// Silhouette curves: the outline of the smooth shape, which crosses triangles instead of following edges.
//
// Based on: L. Wang, C. Tu, W. Wang, X. Meng, B. Chan, D. Yan, "Silhouette Smoothing for Real-Time Rendering
// of Mesh Surfaces", section III. Differs in: what contour.h, crossed_edges.h, feature_curves.h, remesh.h,
// blocking.h and ring.h say, one for each of its steps.
//
// The order of a view's steps is here, and what is kept from view to view; curves_pass.h has the steps.
//
// However wrong normals are, a new vertex is within 0.9 of its triangle's longest side of where its origin is on the flat
// one (with fitted curves as far as their patches go): 0.3 for the bridge, 0.3 of at most 1.6 sides for the segment, 0.09 for a polyline outside its curve.
#include <chrono>

#include "raster/base/scratch.h"
#include "silhouette/curve_set.h"
#include "silhouette/curves_pass.h"
#include "silhouette/method.h"

namespace limn::silhouette {

void CurvesPass::run() {
  const auto start = std::chrono::steady_clock::now();
  forgetRecords();
  stream.setCounts(0, 0);
  scratch.search.run(mesh, topology, prepared, view, parameters, crew);
  findEdges();
  report.classifyMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  listReplaced(scratch.segmentTriangles);
  findSegments();
  lowerPoints();
  placeEdges();
  listReplaced(scratch.triangles);
  placePieces();
  if (parameters.listContour) listContour();
}

// Those of the last refinement, which may have ended with an exception.
void CurvesPass::forgetRecords() {
  for (const CrossedEdge& edge : scratch.edges) scratch.recordOf[edge.edge] = kNone;
  for (const std::uint32_t triangle : scratch.segmentTriangles) scratch.segmentOf[triangle] = kNone;
  for (const std::uint32_t vertex : scratch.lowered) scratch.loweredOf[vertex] = kNone;
}

namespace {

class SilhouetteCurves final : public MethodState {
 public:
  explicit SilhouetteCurves(const Source& source)
      : mesh_(source.mesh),
        topology_(*source.topology),
        fitted_(source.fitted),
        scratch_(static_cast<std::size_t>(source.threads)) {}

  void deform(const Mesh& mesh) override {
    mesh_ = mesh;
    isPrepared_ = false;
    isRigid_ = false;
  }

  void prepare(const Parameters& parameters, const Crew& crew) override {
    const Parameters wanted = whereFitted(parameters);
    const Style style{wanted.robust, wanted.features, wanted.boundaries};
    if (isPrepared_ && style == style_) return;
    prepared_.prepare(mesh_, topology_, fitted_, wanted, crew);
    if (isRigid_) prepared_.dropScaffold();
    style_ = style;
    isPrepared_ = true;
  }

  void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
              RefineReport& report) override {
    CurvesPass::Scratch& scratch = scratch_[crew.slot()];
    if (scratch.recordOf.empty()) {
      scratch.recordOf.assign(topology_.edges().size(), kNone);
      scratch.segmentOf.assign(mesh_.triangleCount(), kNone);
      scratch.loweredOf.assign(mesh_.positions.size(), kNone);
    }
    CurvesPass pass{{mesh_, topology_, view, parameters, crew, stream, report}, prepared_, scratch};
    pass.run();
  }

  void levelScratch() override {
    using Scratch = CurvesPass::Scratch;
    levelCapacity(scratch_, &Scratch::blockCounts, &Scratch::edges, &Scratch::recordOf, &Scratch::triangles,
                  &Scratch::segments, &Scratch::segmentOf, &Scratch::segmentTriangles, &Scratch::planes,
                  &Scratch::loweredOf, &Scratch::lowered, &Scratch::slots);
    const auto searched = [](auto EdgeSearch::*vector) {
      return [vector](Scratch & slot) -> auto& {
        return slot.search.*vector;
      };
    };
    levelCapacity(scratch_, searched(&EdgeSearch::heights), searched(&EdgeSearch::visible),
                  searched(&EdgeSearch::planeHeights), searched(&EdgeSearch::states),
                  searched(&EdgeSearch::candidatesOfRun), searched(&EdgeSearch::candidates),
                  searched(&EdgeSearch::alphas), searched(&EdgeSearch::crossed),
                  searched(&EdgeSearch::points), searched(&EdgeSearch::pointsOf),
                  searched(&EdgeSearch::blockCounts));
  }

 private:
  struct Style {
    bool robust = false, features = false, boundaries = false;
    bool operator==(const Style&) const = default;
  };

  // Fitted boundaries are known, not guessed.
  Parameters whereFitted(const Parameters& parameters) const {
    Parameters wanted = parameters;
    wanted.boundaries = wanted.boundaries || !fitted_.empty();
    return wanted;
  }

  Mesh mesh_;
  const Topology& topology_;
  FittedCurves fitted_;
  std::vector<CurvesPass::Scratch> scratch_;
  CurveSet prepared_;
  Style style_;
  bool isPrepared_ = false, isRigid_ = true;
};

}  // namespace

std::unique_ptr<MethodState> makeSilhouetteCurves(const Source& source) {
  return std::make_unique<SilhouetteCurves>(source);
}

}  // namespace limn::silhouette
