#include "silhouette/refine.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "raster/base/check.h"
#include "silhouette/method.h"

namespace limn::silhouette {
namespace {

// The methods, in the order of `Method`.
constexpr std::array<std::unique_ptr<MethodState> (*)(const Source&), 4> kMethods = {
    makeFlat, makeBlendedPatches, makeSilhouetteCurves, makePnTriangles};

// Meshes below are refined by one thread each when there are several, meshes above by all threads, one by
// one.
constexpr std::size_t kLargeMesh = 20000;

bool isBeta(float beta) {
  return beta >= 0.0f && std::isfinite(beta);
}

void requireValid(const Parameters& p, const Topology& topology) {
  require(static_cast<std::size_t>(p.method) < kMethods.size(), "unknown method");
  require(p.tolerance >= 0.0f, "tolerance must be at least 0");
  require(p.segments >= 0 && p.segments <= kMaxSegments, "segments must be 0 to kMaxSegments");
  require(isBeta(p.beta), "beta must be at least 0");
  require(p.wedgeDegrees >= 0.0f && p.wedgeDegrees <= 180.0f, "wedgeDegrees must be 0 to 180");
  require(p.edgeBetas.empty() || p.edgeBetas.size() == topology.edges().size(),
          "one of edgeBetas for each edge");
  require(std::all_of(p.edgeBetas.begin(), p.edgeBetas.end(), isBeta), "edgeBetas must be at least 0");
}

void requireValid(const View& view) {
  const Projection& p = view.projection;
  require(p.pixelsX > 0.0f && p.pixelsY > 0.0f, "pixels per unit must be above 0");
  require(!p.perspective || p.nearPlane > 0.0f, "the near plane of a perspective view must be above 0");
}

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct Refiner::State {
  Source source;
  Workers* workers = nullptr;
  std::array<std::unique_ptr<MethodState>, kMethods.size()> methods;  // made when first wanted
  std::size_t tasks = 0;                                              // of the refineAll() that runs

  MethodState& methodOf(const Parameters& parameters) {
    requireValid(parameters, *source.topology);
    const auto index = static_cast<std::size_t>(parameters.method);
    if (!methods[index]) methods[index] = kMethods[index](source);
    return *methods[index];
  }

  void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
              RefineReport& report) {
    const auto start = std::chrono::steady_clock::now();
    report = {};
    stream.restart(source.mesh.triangleCount());
    methods[static_cast<std::size_t>(parameters.method)]->refine(view, parameters, crew, stream, report);
    report.refinedTriangles = stream.triangleCount();
    report.refineMs = millisecondsSince(start) - report.classifyMs;
  }

  bool isLarge() const { return source.mesh.triangleCount() >= kLargeMesh; }
};

Refiner::Refiner(const Mesh& mesh, const Topology& topology, Workers& workers, const FittedCurves& fitted)
    : state_(std::make_unique<State>()) {
  require(
      topology.sideEdges().size() == mesh.indices.size() && topology.points().size() == mesh.positions.size(),
      "the topology must be that of the mesh");
  require(mesh.normals.size() == mesh.positions.size(), "one normal per position");
  require(fitted.empty() || (fitted.edges.size() == topology.edges().size() &&
                             fitted.centers.size() == mesh.triangleCount()),
          "fitted curves: one for each edge of the topology and one center for each triangle");
  state_->source = {mesh, &topology, workers.threads(), fitted};
  state_->workers = &workers;
}

Refiner::~Refiner() = default;
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;

void Refiner::deform(const Mesh& mesh) {
  const Mesh& old = state_->source.mesh;
  require(mesh.positions.size() == old.positions.size() && mesh.normals.size() == old.normals.size() &&
              mesh.indices.size() == old.indices.size(),
          "a deformed mesh has the counts of the first");
  state_->source.mesh = mesh;
  for (const auto& method : state_->methods)
    if (method) method->deform(mesh);
}

void Refiner::refine(const View& view, const Parameters& parameters, RefinedStream& stream,
                     RefineReport* report) {
  requireValid(view);
  const Crew crew(*state_->workers);
  state_->methodOf(parameters).prepare(parameters, crew);
  RefineReport unwanted;
  state_->refine(view, parameters, crew, stream, report != nullptr ? *report : unwanted);
}

void Refiner::silhouetteness(const View& view, const Parameters& parameters, std::vector<float>& alphas) {
  requireValid(view);
  MethodState& method = state_->methodOf(parameters);
  method.prepare(parameters, Crew(*state_->workers));
  alphas.assign(state_->source.topology->edges().size(), 0.0f);
  method.silhouetteness(view, parameters, alphas);
}

void refineAll(std::span<RefineTask> tasks, const Parameters& parameters, Workers& workers) {
  for (const RefineTask& task : tasks) {
    require(task.refiner != nullptr && task.stream != nullptr, "a task names a refiner and a stream");
    require(task.refiner->state_->workers == &workers, "the refiners' workers do the work");
    requireValid(task.view);
    task.refiner->state_->methodOf(parameters).prepare(parameters, Crew(workers));
    task.refiner->state_->tasks = 0;
  }
  for (const RefineTask& task : tasks) ++task.refiner->state_->tasks;
  for (RefineTask& task : tasks)
    if (Refiner::State& state = *task.refiner->state_; state.isLarge())
      state.refine(task.view, parameters, Crew(workers), *task.stream, task.report);
  workers.forBlocks(tasks.size(), 1, [&](std::size_t begin, std::size_t end, int slot) {
    for (std::size_t k = begin; k < end; ++k)
      if (Refiner::State& state = *tasks[k].refiner->state_; !state.isLarge())
        state.refine(tasks[k].view, parameters, Crew(state.tasks == 1 ? 0 : slot), *tasks[k].stream,
                     tasks[k].report);
  });
  for (const RefineTask& task : tasks)
    if (task.refiner->state_->tasks > 1) task.refiner->state_->methodOf(parameters).levelScratch();
}

}  // namespace limn::silhouette
