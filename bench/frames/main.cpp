// limn_bench_frames: whole frames of the grid scene, refined and rasterized, with the picture in client memory.
#include <sys/resource.h>

#include <hwy/targets.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>

#include "apps/scene/frame.h"
#include "apps/scene/image.h"
#include "bench/frames/allocations.h"
#include "bench/frames/grid_scene.h"
#include "bench/frames/options.h"
#include "bench/frames/timing.h"

namespace limn::bench {
namespace {

struct Options {
  SceneOptions scene;
  silhouette::Parameters refinement;
  int samples = 1;
  raster::Encoding encoding = raster::Encoding::kNone;
  raster::Tuning tuning;
};

constexpr std::pair<const char*, silhouette::Method> kMethods[] = {{"flat", silhouette::Method::kFlat},
                                                                   {"patches", silhouette::Method::kPatches},
                                                                   {"curves", silhouette::Method::kCurves},
                                                                   {"pn", silhouette::Method::kPn}};

/// Leaves the rasterizer one instruction set, or plain C++.
void useInstructions(const std::string& name, raster::Tuning& tuning) {
  tuning.scalar = name == "scalar";
  if (tuning.scalar) return;
  const std::map<std::string, std::int64_t> targets{
      {"SSE4", HWY_SSE4}, {"AVX2", HWY_AVX2}, {"AVX-512", HWY_AVX3}};
  const std::int64_t target = targets.at(name);
  if ((hwy::SupportedTargets() & target) == 0)
    throw CLI::ValidationError("--simd", "this machine has no " + name);
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().DeInit();
}

const char* nameOf(silhouette::Method method) {
  for (const auto& [name, value] : kMethods) {
    if (value == method) return name;
  }
  return "";
}

Options parse(int argc, char** argv) {
  CLI::App app("Times frames of copies of a mesh on a grid and prints key=value lines.");
  Options options;
  options.refinement.method = silhouette::Method::kFlat;
  declare(app, options.scene, "all threads that work, the calling one included");
  app.add_option("--method", options.refinement.method, "flat, patches, curves or pn")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, silhouette::Method>(std::begin(kMethods), std::end(kMethods))))
      ->default_str("flat");
  app.add_option("--tolerance", options.refinement.tolerance, "pixels")->capture_default_str();
  app.add_option("--segments", options.refinement.segments, "a fixed count per edge instead")
      ->capture_default_str();
  app.add_option("--samples", options.samples, "per pixel")
      ->check(CLI::IsMember({1, 4, 8}))
      ->capture_default_str();
  app.add_option("--encode", options.encoding,
                 "display values as they are (none), or from linear light (srgb)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, raster::Encoding>{
          {"none", raster::Encoding::kNone}, {"srgb", raster::Encoding::kSrgb}}))
      ->default_str("none");
  std::string instructions;
  app.add_option("--simd", instructions, "only this instruction set: scalar, SSE4, AVX2 or AVX-512")
      ->check(CLI::IsMember({"scalar", "SSE4", "AVX2", "AVX-512"}));
  try {
    app.parse(argc, argv);
    if (options.scene.threads < 1) throw CLI::ValidationError("--threads", "is at least 1");
    if (!instructions.empty()) useInstructions(instructions, options.tuning);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return options;
}

/// The model and, if asked for, its texture, with the peer's material.
scene::Scene makeScene(const Options& options) {
  scene::Scene scene;
  scene.meshes.push_back(loadFitted(options.scene.model));
  raster::Material material;
  if (options.scene.texture != 0) {
    raster::Sampler sampler;
    sampler.minification =
        options.scene.texture == 1 ? raster::Filter::kLinearMipNearest : raster::Filter::kLinearMipLinear;
    const auto content = options.encoding == raster::Encoding::kSrgb ? raster::Texture::Content::kSrgb
                                                                     : raster::Texture::Content::kLinear;
    scene.textures.push_back(
        std::make_unique<raster::Texture>(kTextureSize, kTextureSize, checkerTexture(), content, sampler));
    material.baseColor = glm::vec4(1.0f);
    material.baseColorTexture = scene.textures.back().get();
  }
  scene.materials.push_back(material);
  return scene;
}

class Bench {
 public:
  explicit Bench(const Options& options)
      : options_(options),
        grid_(options.scene.copies, options.scene.width, options.scene.height),
        scene_(makeScene(options)),
        drawer_(scene_, options.scene.threads, options.tuning) {
    camera_.projection = grid_.projection();
    settings_.refinement = options.refinement;
    settings_.samples = options.samples;
    settings_.background = glm::vec4(kBackground, 0.0f);
    settings_.light = scene::LightChoice::kPeer;
    settings_.encoding = options.encoding;
    pose_.instances.resize(static_cast<std::size_t>(options.scene.copies));
    scale_ = options.scene.scale > 0.0 ? options.scene.scale : findScale(options.scene, [&](double scale) {
      scale_ = scale;
      draw(0);
      return coverage();
    });
  }

  void run();

 private:
  Options options_;
  Grid grid_;
  scene::Scene scene_;
  scene::FrameDrawer drawer_;
  scene::Pose pose_;
  scene::CameraView camera_;
  scene::FrameSettings settings_;
  scene::Image image_;
  double scale_ = 1.0;

  void draw(int view, scene::FrameStatistics* statistics = nullptr) {
    for (int copy = 0; copy < grid_.copies(); ++copy) {
      pose_.instances[static_cast<std::size_t>(copy)].toWorld =
          grid_.place(copy, view, options_.scene.views, scale_);
    }
    drawer_.draw(pose_, camera_, settings_, image_, statistics);
  }

  double coverage() const {
    std::size_t covered = 0;
    for (std::size_t i = 3; i < image_.rgba.size(); i += 4) covered += image_.rgba[i] != 0;
    return 4.0 * static_cast<double>(covered) / static_cast<double>(image_.rgba.size());
  }

  struct Survey {
    double coverage = 0;
    scene::FrameStatistics sum;
  };
  Survey survey();
  void printStages(const Survey& survey) const;
};

// One turn with statistics, apart from the timing: counting takes time.
Bench::Survey Bench::survey() {
  Survey survey;
  const double share = 1.0 / options_.scene.views;
  for (int view = 0; view < options_.scene.views; ++view) {
    scene::FrameStatistics frame;
    draw(view, &frame);
    survey.coverage += share * coverage();
    raster::Statistics& sum = survey.sum.raster;
    sum.trianglesIn += frame.raster.trianglesIn;
    sum.trianglesDrawn += frame.raster.trianglesDrawn;
    sum.pixelsShaded += frame.raster.pixelsShaded;
    sum.transformMs += share * frame.raster.transformMs;
    sum.setupMs += share * frame.raster.setupMs;
    sum.binningMs += share * frame.raster.binningMs;
    sum.visibilityMs += share * frame.raster.visibilityMs;
    sum.shadingMs += share * frame.raster.shadingMs;
    sum.resolveMs += share * frame.raster.resolveMs;
    sum.scratchBytes = frame.raster.scratchBytes;
    survey.sum.refine.classifyMs += share * frame.refine.classifyMs;
    survey.sum.refine.refineMs += share * frame.refine.refineMs;
    survey.sum.refineMs += share * frame.refineMs;
    survey.sum.rasterMs += share * frame.rasterMs;
  }
  return survey;
}

// refine_wall and raster_wall follow each other; the stages within are summed over the threads.
void Bench::printStages(const Survey& survey) const {
  const scene::FrameStatistics& s = survey.sum;
  std::printf("refine_wall_ms=%.4f raster_wall_ms=%.4f classify_ms=%.4f refine_ms=%.4f\n", s.refineMs,
              s.rasterMs, s.refine.classifyMs, s.refine.refineMs);
  std::printf(
      "transform_ms=%.4f setup_ms=%.4f binning_ms=%.4f visibility_ms=%.4f shading_ms=%.4f resolve_ms=%.4f\n",
      s.raster.transformMs, s.raster.setupMs, s.raster.binningMs, s.raster.visibilityMs, s.raster.shadingMs,
      s.raster.resolveMs);
}

void Bench::run() {
  const SceneOptions& o = options_.scene;
  const Survey seen = survey();
  if (!o.dump.empty()) {
    draw(0);
    const std::vector<std::uint8_t> png = scene::encodePng(image_, {}, 1);
    scene::writeFileWhole(o.dump, png.data(), png.size());
  }
  std::uint64_t allocations = 0;
  const FrameTimes times = FrameClock(o.views).run(o.seconds, [&](int view) {
    const std::uint64_t before = allocationCount();
    draw(view);
    allocations += allocationCount() - before;
  });

  const std::size_t trianglesIn = scene_.meshes[0].indices.size() / 3 * pose_.instances.size();
  const double trianglesDrawn = static_cast<double>(seen.sum.raster.trianglesIn) / o.views;
  const double pixelsShaded = static_cast<double>(seen.sum.raster.pixelsShaded) / o.views;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "model=%s method=%s tolerance=%g segments=%d copies=%d size=%dx%d samples=%d texture=%d threads=%d\n",
      o.model.c_str(), nameOf(options_.refinement.method), static_cast<double>(options_.refinement.tolerance),
      options_.refinement.segments, o.copies, o.width, o.height, options_.samples, o.texture, o.threads);
  std::printf("scale=%.5f tris_in=%zu tris_drawn=%.0f coverage=%.4f pixels_shaded=%.0f frames=%d\n", scale_,
              trianglesIn, trianglesDrawn, seen.coverage, pixelsShaded, times.frames);
  std::printf("min_ms=%.4f median_ms=%.4f cpu_ms=%.4f mpix_s=%.1f mtri_s=%.3f allocs_per_frame=%.3f\n",
              times.minMs, times.medianMs, times.cpuMs, 1e-3 * pixelsShaded / times.minMs,
              1e-3 * trianglesDrawn / times.minMs, static_cast<double>(allocations) / times.frames);
  printStages(seen);
  std::printf("scratch_bytes=%zu max_rss_bytes=%ld\n", seen.sum.raster.scratchBytes, 1024 * usage.ru_maxrss);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  const limn::bench::Options options = limn::bench::parse(argc, argv);
  try {
    limn::bench::Bench(options).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "limn_bench_frames: %s\n", error.what());
    return 1;
  }
  return 0;
}
