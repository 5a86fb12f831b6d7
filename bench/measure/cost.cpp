#include "bench/measure/cost.h"

#include <algorithm>
#include <chrono>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"

namespace limn::measure {
namespace {

constexpr int kWidth = 1280, kHeight = 800;

struct Sample {
  double frameMs = 0.0, refineMs = 0.0;
};

}  // namespace

std::vector<Cost> measureCosts(const std::string& model, const std::vector<Variant>& variants, int views,
                               int rounds, int threads) {
  const scene::Scene scene = scene::load(model);
  scene::Pose pose;
  scene::evaluatePose(scene, -1, 0.0, pose);
  const scene::Sphere bounds = scene::boundingSphere(scene, pose);
  scene::FrameDrawer drawer(scene, threads);
  scene::Image image;
  scene::FrameSettings settings;

  std::vector<Cost> costs(variants.size());
  for (int view = 0; view < views; ++view) {
    const double azimuth = 30.0 + 360.0 * view / views;
    const scene::LookAt lookAt = scene::frameSphere(bounds, kWidth, kHeight, azimuth, 20.0, 1.0, 30.0, 0.0);
    const scene::CameraView camera = scene::makeCamera(lookAt, bounds, kWidth, kHeight);
    std::vector<std::vector<Sample>> samples(variants.size());
    std::vector<double> triangles(variants.size());
    for (int round = -1; round < rounds; ++round) {  // the first warms up
      for (std::size_t v = 0; v < variants.size(); ++v) {
        settings.refinement = variants[v].parameters;
        scene::FrameStatistics statistics;
        const auto start = std::chrono::steady_clock::now();
        drawer.draw(pose, camera, settings, image, &statistics);
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        if (round >= 0) samples[v].push_back({time.count(), statistics.refineMs});
        triangles[v] = static_cast<double>(statistics.raster.trianglesIn);
      }
    }
    for (std::size_t v = 0; v < variants.size(); ++v) {
      std::sort(samples[v].begin(), samples[v].end(), [](auto a, auto b) { return a.frameMs < b.frameMs; });
      costs[v].minMs += samples[v].front().frameMs / views;
      costs[v].medianMs += samples[v][samples[v].size() / 2].frameMs / views;
      costs[v].refineMs += samples[v].front().refineMs / views;
      costs[v].triangles += triangles[v] / views;
    }
  }
  return costs;
}

}  // namespace limn::measure
