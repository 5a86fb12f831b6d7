// limn refine: what a frame draws, as triangles.
#include <unistd.h>

#include "apps/limn/commands.h"
#include "apps/limn/terminal.h"
#include "apps/limn/values.h"
#include "apps/scene/gltf_export.h"
#include "apps/scene/load.h"

namespace limn::program {

int refine(const RefineOptions& options) {
  if (options.output.empty()) throw UsageError("no output; name one with -o, like -o refined.glb");
  const bool toStandardOutput = options.output == "-";
  if (toStandardOutput && ::isatty(STDOUT_FILENO) == 1)
    throw UsageError("standard output is a terminal; redirect it to a file or a pipe");
  const scene::Source source = scene::openSource(options.job.model, {options.job.creaseDegrees});
  const scene::Scene& scene = source.scene;
  if (!options.quiet)
    for (const std::string& notice : scene.notices) printMessage("note: " + notice);
  const Job job = makeJob(scene, options.job);
  if (options.frame > job.frameCount())
    throw UsageError("--frame: the job has " + std::to_string(job.frameCount()) + " frames");

  scene::Pose pose;
  scene::FrameDrawer drawer(scene, options.threads);
  job.pose(options.frame, pose, &drawer.workers());
  drawer.refine(pose, job.camera(options.frame, pose), job.settings(options.frame));
  const std::vector<std::uint8_t> glb =
      scene::exportRefined(source, pose, drawer, {options.alphas, job.text(options.frame)});
  if (toStandardOutput) {
    scene::writeAll(STDOUT_FILENO, "standard output", glb.data(), glb.size());
    return kDone;
  }
  scene::makeDirectoriesOf(options.output);
  scene::writeFileWhole(options.output, glb.data(), glb.size());
  return kDone;
}

}  // namespace limn::program
