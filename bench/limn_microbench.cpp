// limn_microbench: kernels and stages by themselves, through Google Benchmark. `items` are edges, triangles, pixels or
// calls: what the kernel's name says.
#include <benchmark/benchmark.h>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"
#include "bench/measure/model.h"
#include "bench/measure/views.h"
#include "raster/base/elementary.h"
#include "silhouette/contour.h"
#include "silhouette/edge_clusters.h"
#include "silhouette/edge_curves.h"
#include "silhouette/robust_ends.h"
#include "silhouette/silhouetteness.h"

namespace {

using namespace limn;
using silhouette::Method;

constexpr int kSize = 1024;

// The icosphere of a level with what the stages take.
struct Ball {
  std::vector<measure::PlacedMesh> meshes;
  silhouette::Mesh shape;
  silhouette::Topology topology;
  scene::CameraView camera;

  explicit Ball(int level)
      : meshes(measure::loadMeshes("builtin:icosphere:" + std::to_string(level))),
        shape(meshes.front().shape()),
        topology(shape),
        camera(measure::outlineCamera({{0, 0, 0}, 1.0}, measure::standardDirections()[5], kSize)) {}
  silhouette::View view() const { return silhouette::makeView(camera.projection, camera.worldToView); }
};

void sines(benchmark::State& state) {
  double x = 0.1;
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(sinCos(x += 0.37));
}
BENCHMARK(sines);

void powers(benchmark::State& state) {
  double x = 0.1;
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(power(x += 1e-6, 2.4));
}
BENCHMARK(powers);

void contourRoots(benchmark::State& state) {
  double b = -1.0;
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(silhouette::contourRoot(0.3, b += 1e-6, -0.7));
}
BENCHMARK(contourRoots);

void topology(benchmark::State& state) {
  const Ball ball(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(silhouette::Topology(ball.shape).edges().data());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(ball.shape.triangleCount()));
}
BENCHMARK(topology)->Arg(2)->Arg(5)->Unit(benchmark::kMicrosecond);

void silhouetteness(benchmark::State& state) {
  const Ball ball(5);
  silhouette::Parameters parameters;
  parameters.silhouetteness = static_cast<silhouette::Silhouetteness>(state.range(0));
  silhouette::EdgeTest test;
  test.prepare(ball.shape, ball.topology, parameters, silhouette::Crew(0));
  const silhouette::View view = ball.view();
  const std::size_t edges = ball.topology.edges().size();
  for ([[maybe_unused]] auto _ : state) {
    float sum = 0.0f;
    for (std::size_t e = 0; e < edges; ++e) sum += test.alpha(view, parameters, e);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(edges));
}
BENCHMARK(silhouetteness)->ArgName("kind")->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void edgeCurves(benchmark::State& state) {
  const Ball ball(5);
  std::vector<silhouette::CurveOffsets> curves;
  silhouette::RobustEnds robust;
  const silhouette::CurveStyle style{static_cast<silhouette::Tangents>(state.range(0)), state.range(1) != 0};
  for ([[maybe_unused]] auto _ : state) {
    const silhouette::Crew crew(0);
    robust.prepare(ball.shape, ball.topology, crew);
    silhouette::computeEdgeCurves(ball.shape, ball.topology, style, crew, robust, curves);
    benchmark::DoNotOptimize(curves.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(curves.size()));
}
BENCHMARK(edgeCurves)
    ->ArgNames({"tangents", "robust"})
    ->Args({0, 0})
    ->Args({0, 1})
    ->Args({1, 1})
    ->Args({2, 1})
    ->Unit(benchmark::kMicrosecond);

// Which edges bend, one thread: by clusters, or edge by edge in the same vectors (no cluster is passed over). Where the
// two rows meet is the break-even of the search.
void classification(benchmark::State& state) {
  const Ball ball(static_cast<int>(state.range(0)));
  const bool linear = state.range(1) != 0;
  silhouette::Parameters parameters;
  parameters.tolerance = 0.25f;
  const silhouette::Crew crew(0);
  silhouette::EdgeTest test;
  silhouette::RobustEnds robust;
  std::vector<silhouette::CurveOffsets> curves;
  silhouette::EdgeClusters clusters;
  test.prepare(ball.shape, ball.topology, parameters, crew);
  silhouette::computeEdgeCurves(ball.shape, ball.topology, {parameters.tangents, false}, crew, robust,
                                curves);
  clusters.build(ball.shape, ball.topology);
  clusters.update(ball.shape, ball.topology, test, curves, {}, parameters, crew);
  silhouette::EdgeClusters::Eye eye = clusters.eyeOf(ball.view(), parameters);
  if (linear) {
    eye.tolerance = 0.0f;
    eye.beta = 1e30f;
  }
  std::vector<float> alphas(silhouette::kEdgesPerCluster);
  float scale = 0.0f;
  for ([[maybe_unused]] auto _ : state) {
    std::uint64_t bends = 0;
    for (std::size_t c = 0; c < clusters.count(); ++c)
      bends ^= clusters.classify(c, eye, test, alphas, scale);
    benchmark::DoNotOptimize(bends);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(ball.topology.edges().size()));
}
BENCHMARK(classification)
    ->ArgNames({"level", "linear"})
    ->ArgsProduct({{0, 1, 2, 3, 4, 6, 8}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

// The goal: at most 1 ms per million edges (1e9 items a second) of a mesh with 1.3 million triangles on two threads; with
// no edge that bends by a quarter of a pixel, and with all that the contour comes near to, however little they bend.
void classificationOfMany(benchmark::State& state) {
  const Ball ball(8);
  Workers workers(2);
  silhouette::Refiner refiner(ball.shape, ball.topology, workers);
  silhouette::Parameters parameters;
  if (state.range(0) != 0) parameters.segments = 1;
  silhouette::RefinedStream stream;
  silhouette::RefineReport report;
  const silhouette::View view = ball.view();
  refiner.refine(view, parameters, stream, &report);
  for ([[maybe_unused]] auto _ : state) {
    refiner.refine(view, parameters, stream, &report);
    state.SetIterationTime(1e-3 * report.classifyMs);
  }
  state.counters["bending"] = static_cast<double>(report.smoothEdges);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(ball.topology.edges().size()));
}
BENCHMARK(classificationOfMany)
    ->ArgName("many")
    ->Arg(0)
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void refine(benchmark::State& state, Method method, double tolerance) {
  const Ball ball(static_cast<int>(state.range(0)));
  Workers workers(1);
  silhouette::Refiner refiner(ball.shape, ball.topology, workers);
  silhouette::Parameters parameters;
  parameters.method = method;
  parameters.tolerance = static_cast<float>(tolerance);
  silhouette::RefinedStream stream;
  const silhouette::View view = ball.view();
  for ([[maybe_unused]] auto _ : state) refiner.refine(view, parameters, stream);
  state.counters["triangles_out"] = static_cast<double>(stream.triangleCount());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(ball.shape.triangleCount()));
}
BENCHMARK_CAPTURE(refine, patches_2, Method::kPatches, 2.0)->Arg(2)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(refine, patches_025, Method::kPatches, 0.25)
    ->Arg(2)
    ->Arg(5)
    ->Arg(7)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(refine, curves_025, Method::kCurves, 0.25)
    ->Arg(2)
    ->Arg(5)
    ->Arg(7)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(refine, pn_025, Method::kPn, 0.25)->Arg(2)->Unit(benchmark::kMicrosecond);

// Whole frames of one ball at 1024², one thread: items are pixels.
void frame(benchmark::State& state, Method method) {
  const scene::Scene scene = scene::load("builtin:icosphere:" + std::to_string(state.range(0)));
  scene::Pose pose;
  scene::evaluatePose(scene, -1, 0.0, pose);
  const scene::CameraView camera =
      measure::outlineCamera(scene::boundingSphere(scene, pose), measure::standardDirections()[5], kSize);
  scene::FrameDrawer drawer(scene, 1);
  scene::FrameSettings settings;
  settings.samples = static_cast<int>(state.range(1));
  settings.refinement.method = method;
  scene::Image image;
  for ([[maybe_unused]] auto _ : state) drawer.draw(pose, camera, settings, image);
  state.SetItemsProcessed(state.iterations() * kSize * kSize);
}
BENCHMARK_CAPTURE(frame, flat, Method::kFlat)
    ->ArgNames({"level", "samples"})
    ->Args({2, 1})
    ->Args({2, 4})
    ->Args({7, 1})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, patches, Method::kPatches)
    ->ArgNames({"level", "samples"})
    ->Args({2, 1})
    ->Args({2, 4})
    ->Args({7, 1})
    ->Unit(benchmark::kMillisecond);

void encodePng(benchmark::State& state) {
  scene::Image image{kSize, kSize, std::vector<std::uint8_t>(std::size_t{kSize} * kSize * 4)};
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = static_cast<std::uint8_t>(i * i / 4096);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(scene::encodePng(image, {}, static_cast<int>(state.range(0))).size());
  state.SetItemsProcessed(state.iterations() * kSize * kSize);
}
BENCHMARK(encodePng)->ArgName("level")->Arg(1)->Arg(6)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
