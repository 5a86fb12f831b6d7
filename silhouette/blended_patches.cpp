// View-dependent blended Bézier patches: flat away from the silhouette, smooth at it, continuous in the
// viewpoint.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004. Differs in: what patches_edges.cpp,
// patches_cuts.cpp and patch.h say, one for each of its steps.
//
// The order of a view's steps is here, and what is kept from view to view; patches_pass.h has the steps.
#include <array>
#include <chrono>

#include "raster/base/scratch.h"
#include "silhouette/edge_clusters.h"
#include "silhouette/edge_curves.h"
#include "silhouette/fitted_curves.h"
#include "silhouette/method.h"
#include "silhouette/patches_pass.h"
#include "silhouette/silhouetteness.h"

namespace limn::silhouette {

void PatchesPass::run() {
  const auto start = std::chrono::steady_clock::now();
  forgetRecords();
  classify();
  report.classifyMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  measureEdges();
  listCandidates();
  place();
  emit();
}

// Those of the last refinement, which may have ended with an exception.
void PatchesPass::forgetRecords() {
  for (const SmoothEdge& smooth : scratch.smooth)
    if (smooth.bends()) scratch.recordOf[smooth.edge] = 0;
}

namespace {

using glm::vec3;

class BlendedPatches final : public MethodState {
 public:
  explicit BlendedPatches(const Source& source)
      : mesh_(source.mesh),
        topology_(*source.topology),
        fitted_(source.fitted),
        scratch_(static_cast<std::size_t>(source.threads)) {}

  void deform(const Mesh& mesh) override {
    mesh_ = mesh;
    isRigid_ = false;
    prepared_ = false;
  }

  void prepare(const Parameters& parameters, const Crew& crew) override {
    const CurveStyle style{parameters.tangents, parameters.robust};
    const std::array<bool, 2> always{parameters.features, parameters.boundaries};
    if (prepared_ && style == style_ && parameters.wedgeDegrees == wedgeDegrees_ &&
        parameters.beta == beta_ && always == always_ && parameters.edgeBetas.empty())
      return;
    test_.prepare(mesh_, topology_, parameters, crew);
    if (fitted_.empty())
      computeEdgeCurves(mesh_, topology_, style, crew, robust_, curves_);
    else
      placeFittedCurves(mesh_, topology_, fitted_, crew, curves_, centers_);
    if (isRigid_) robust_ = {};  // not asked again
    if (clusters_.count() == 0) clusters_.build(mesh_, topology_);
    clusters_.update(mesh_, topology_, test_, curves_, centers_, whereFitted(parameters), crew);
    style_ = style;
    wedgeDegrees_ = parameters.wedgeDegrees;
    beta_ = parameters.beta;
    always_ = {parameters.features, parameters.boundaries};
    prepared_ = parameters.edgeBetas.empty();
  }

  void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
              RefineReport& report) override {
    PatchesPass::Scratch& scratch = scratch_[crew.slot()];
    const Parameters wanted = whereFitted(parameters);
    if (scratch.recordOf.empty()) scratch.recordOf.assign(topology_.edges().size(), 0);
    PatchesPass pass{
        {mesh_, topology_, view, wanted, crew, stream, report}, test_, clusters_, curves_, centers_, scratch};
    pass.run();
  }

  void levelScratch() override {
    using Scratch = PatchesPass::Scratch;
    levelCapacity(scratch_, &Scratch::blockCounts, &Scratch::masks, &Scratch::alphas, &Scratch::scales,
                  &Scratch::smooth, &Scratch::recordOf, &Scratch::candidates, &Scratch::firstCut,
                  &Scratch::cuts, &Scratch::shares);
  }

  void silhouetteness(const View& view, const Parameters& parameters, std::vector<float>& alphas) override {
    const Parameters wanted = whereFitted(parameters);
    for (std::size_t e = 0; e < alphas.size(); ++e) alphas[e] = test_.alpha(view, wanted, e);
  }

 private:
  // Fitted curves are known, not guessed: boundaries are always smooth, and edges wherever the contour may come near,
  // since the fitted outline need not run where the shading normals have it.
  Parameters whereFitted(const Parameters& parameters) const {
    Parameters wanted = parameters;
    if (fitted_.empty()) return wanted;
    wanted.boundaries = true;
    if (wanted.silhouetteness == Silhouetteness::kCrossing) wanted.silhouetteness = Silhouetteness::kContour;
    return wanted;
  }

  Mesh mesh_;
  const Topology& topology_;
  FittedCurves fitted_;
  std::vector<PatchesPass::Scratch> scratch_;
  EdgeTest test_;
  RobustEnds robust_;
  EdgeClusters clusters_;
  std::vector<CurveOffsets> curves_;
  std::vector<vec3> centers_;  // what a fitted patch adds to b111; empty without fitted curves
  CurveStyle style_;
  float wedgeDegrees_ = 0, beta_ = 0;
  std::array<bool, 2> always_{};  // features, boundaries
  bool prepared_ = false, isRigid_ = true;
};

}  // namespace

std::unique_ptr<MethodState> makeBlendedPatches(const Source& source) {
  return std::make_unique<BlendedPatches>(source);
}

}  // namespace limn::silhouette
