#include "bench/measure/accuracy.h"

#include <algorithm>

#include "bench/measure/views.h"

namespace limn::measure {
namespace {

// What a thread keeps from view to view.
struct Scratch {
  explicit Scratch(int size) : truth(size, size), drawn(size, size) {}
  Mask truth, drawn;
  std::vector<SampleTriangle> triangles;
};

void drawMask(const Surface& surface, const scene::CameraView& camera, std::vector<SampleTriangle>& triangles,
              Mask& mask) {
  project(surface, camera, triangles);
  mask.clear();
  mask.draw(triangles);
}

ViewFigures compare(const Mask& truth, const Outline& trueOutline, const Mask& drawn, int size) {
  const Outline outline = traceOutline(drawn);
  const OutlineDistance distance = outlineDistance(trueOutline, outline, size, size);
  const double trueLength = length(trueOutline);
  ViewFigures figures;
  figures.mean = trueLength > 0.0 ? differenceArea(truth, drawn) / trueLength : 0.0;
  figures.p95 = distance.p95;
  figures.max = distance.max;
  figures.corner = largestTurn(outline);
  return figures;
}

// One view as every variant draws it; index 0 is the flat mesh.
using DrawnView = std::vector<Surface>;

}  // namespace

Accuracy measureAccuracy(const Subject& subject, const std::vector<Variant>& variants,
                         const std::vector<glm::dvec3>& directions, int size, Workers& workers,
                         ViewObserver* observer) {
  Accuracy accuracy;
  accuracy.truth.resize(directions.size());
  accuracy.flat.resize(directions.size());
  accuracy.methods.assign(variants.size(), std::vector<ViewFigures>(directions.size()));
  std::vector<std::unique_ptr<Scratch>> scratches(static_cast<std::size_t>(workers.threads()));
  ModelRefiner refiner(subject.meshes, workers);

  // Refinement uses all threads for a view, measuring a thread per view: a few views are refined, then
  // measured.
  constexpr std::size_t kBatch = 8;
  std::vector<DrawnView> drawn(kBatch, DrawnView(variants.size()));
  for (std::size_t first = 0; first < directions.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, directions.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const scene::CameraView camera = outlineCamera(subject.bounds, directions[first + i], size);
      for (std::size_t v = 0; v < variants.size(); ++v)
        refiner.refine(camera, variants[v].parameters, drawn[i][v]);
    }
    workers.forBlocks(count, 1, [&](std::size_t i, std::size_t, int slot) {
      auto& scratch = scratches[static_cast<std::size_t>(slot)];
      if (!scratch) scratch = std::make_unique<Scratch>(size);
      const std::size_t view = first + i;
      const scene::CameraView camera = outlineCamera(subject.bounds, directions[view], size);
      drawMask(subject.truth, camera, scratch->triangles, scratch->truth);
      const Outline trueOutline = traceOutline(scratch->truth);
      accuracy.truth[view].corner = largestTurn(trueOutline);
      accuracy.truth[view].triangles = subject.truth.triangleCount();
      const auto measure = [&](const Surface& surface, ViewFigures& figures) {
        drawMask(surface, camera, scratch->triangles, scratch->drawn);
        figures = compare(scratch->truth, trueOutline, scratch->drawn, size);
        figures.triangles = surface.triangleCount();
      };
      measure(subject.flat, accuracy.flat[view]);
      for (std::size_t v = 0; v < variants.size(); ++v) {
        measure(drawn[i][v], accuracy.methods[v][view]);
        if (observer != nullptr) observer->see(variants[v], view, scratch->truth, scratch->drawn);
      }
    });
  }
  return accuracy;
}

namespace {

double average(const std::vector<ViewFigures>& views, double ViewFigures::*figure) {
  double sum = 0.0;
  for (const ViewFigures& view : views) sum += view.*figure;
  return sum / static_cast<double>(views.size());
}

double largest(const std::vector<ViewFigures>& views, double ViewFigures::*figure) {
  double most = 0.0;
  for (const ViewFigures& view : views) most = std::max(most, view.*figure);
  return most;
}

}  // namespace

AccuracyRow summarize(const Subject& subject, const Variant& variant, const Accuracy& accuracy,
                      std::size_t index) {
  const std::vector<ViewFigures>& views = accuracy.methods[index];
  AccuracyRow row;
  row.model = subject.pair.name;
  row.method = variant.name;
  row.tolerance = variant.parameters.tolerance;
  row.views = views.size();
  row.mean = average(views, &ViewFigures::mean);
  row.p95 = average(views, &ViewFigures::p95);
  row.max = largest(views, &ViewFigures::max);
  row.corner = largest(views, &ViewFigures::corner);
  row.flatMean = average(accuracy.flat, &ViewFigures::mean);
  row.flatP95 = average(accuracy.flat, &ViewFigures::p95);
  row.flatMax = largest(accuracy.flat, &ViewFigures::max);
  row.flatCorner = largest(accuracy.flat, &ViewFigures::corner);
  row.trueCorner = largest(accuracy.truth, &ViewFigures::corner);
  double triangles = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    triangles += static_cast<double>(views[i].triangles);
    if (views[i].mean > accuracy.flat[i].mean) ++row.viewsWorseThanFlat;
  }
  row.triangles = triangles / static_cast<double>(views.size());
  return row;
}

}  // namespace limn::measure
