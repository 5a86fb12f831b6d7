// limn render: the frames of a job, or those of them that this run is to draw.
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/limn/commands.h"
#include "apps/limn/frame_writer.h"
#include "apps/limn/terminal.h"
#include "apps/limn/values.h"
#include "apps/scene/load.h"
#include "apps/scene/output_file.h"

namespace limn::program {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The frames of this run: a shard of the list that the user gave.
class Selection {
 public:
  Selection(const RenderOptions& options, int jobFrames)
      : list_(options.frames ? FrameList::parse(*options.frames) : FrameList::all(jobFrames)),
        shard_(options.shard) {
    if (list_.largest() > jobFrames)
      throw UsageError("--frames: frame " + std::to_string(list_.largest()) +
                       " is beyond the end of the job, which has " +
                       (jobFrames == 1 ? "one frame; --turntable and --animation make more"
                                       : std::to_string(jobFrames) + " frames"));
  }

  const FrameList& list() const { return list_; }
  int count() const { return (list_.count() - shard_.first + shard_.second) / shard_.second; }
  int frame(int position) const { return list_.at(shard_.first - 1 + position * shard_.second); }

 private:
  FrameList list_;
  std::pair<int, int> shard_;
};

bool isSameFile(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  return fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal();
}

/// Calls visit(path) for the files of all frames, planes included.
template <class Visit>
void forFrameFiles(const RenderOptions& o, const OutputPattern* pattern, const Selection& selection,
                   const Visit& visit) {
  if (pattern == nullptr || pattern->isStandardOutput()) return;
  for (int i = 0; i < selection.count(); ++i) {
    const std::string path = pattern->path(selection.frame(i));
    visit(path);
    for (const Aov aov : o.aovs) visit(besidePath(path, aovName(aov)));
  }
}

/// No result may replace another.
void requireOwnFiles(const RenderOptions& o, const OutputPattern* pattern, const Selection& selection) {
  if (o.statistics && o.manifest && isSameFile(*o.statistics, *o.manifest))
    throw UsageError("--stats names the file of the manifest; give it one of its own");
  const auto check = [&](const char* option, const std::optional<std::string>& file) {
    if (!file) return;
    const std::filesystem::path name = std::filesystem::path(*file).filename();
    forFrameFiles(o, pattern, selection, [&](const std::string& path) {
      if (std::filesystem::path(path).filename() == name && isSameFile(path, *file))
        throw UsageError(std::string(option) + " names the file of a frame, " + path +
                         "; give it one of its own");
    });
  };
  check("--stats", o.statistics);
  check("--manifest", o.manifest);
}

/// Before anything is drawn that would be lost.
void requireWritableFiles(const RenderOptions& o, const OutputPattern* pattern, const Selection& selection) {
  forFrameFiles(o, pattern, selection, scene::requireWritable);
  if (o.statistics) scene::requireWritable(*o.statistics);
  if (o.manifest) scene::requireWritable(*o.manifest);
}

/// Combinations of options that make no sense, before anything is loaded.
void checkOutput(const RenderOptions& o) {
  if (!o.output) {
    if (!o.hash && !o.dryRun && !o.statistics)
      throw UsageError("no output; name one with -o, like -o picture.png");
    if (o.manifest || o.skipExisting || !o.aovs.empty())
      throw UsageError("--manifest, --skip-existing and --aov need files; name them with -o");
    return;
  }
  if (*o.output == "-") {
    if (o.hash)
      throw UsageError("--hash prints on standard output, and so does -o -; write the frames to files");
    if (o.manifest || o.skipExisting || !o.aovs.empty())
      throw UsageError("--manifest, --skip-existing and --aov need files; -o - makes none");
    if (::isatty(STDOUT_FILENO) == 1 && !o.dryRun)
      throw UsageError("standard output is a terminal; redirect it to a file or a pipe");
    return;
  }
  if (o.rgba && o.skipExisting)
    throw UsageError("--skip-existing needs PNG files: raw rows do not say what they are");
  const std::size_t dot = o.output->rfind('.');
  const std::string extension = dot == std::string::npos ? "" : o.output->substr(dot);
  for (const char* other :
       {".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tif", ".tiff", ".exr", ".mp4", ".webm"})
    if (extension == other) throw UsageError("limn writes PNG, not " + extension + "; name the output .png");
}

/// Sums over the frames drawn.
struct Totals {
  int drawn = 0, skipped = 0;
  double loadMs = 0, prepareMs = 0, poseMs = 0, refineMs = 0, rasterMs = 0, totalMs = 0;
  scene::FrameStatistics sum;

  void add(const scene::FrameStatistics& frame) {
    ++drawn;
    refineMs += frame.refineMs;
    rasterMs += frame.rasterMs;
    raster::Statistics& r = sum.raster;
    r.trianglesIn += frame.raster.trianglesIn;
    r.trianglesDrawn += frame.raster.trianglesDrawn;
    r.pixelsShaded += frame.raster.pixelsShaded;
    r.pixelsCovered += frame.raster.pixelsCovered;
    r.transformMs += frame.raster.transformMs;
    r.setupMs += frame.raster.setupMs;
    r.binningMs += frame.raster.binningMs;
    r.visibilityMs += frame.raster.visibilityMs;
    r.shadingMs += frame.raster.shadingMs;
    r.resolveMs += frame.raster.resolveMs;
    r.scratchBytes = frame.raster.scratchBytes;
    sum.refine.curvedTriangles += frame.refine.curvedTriangles;
    sum.refine.refinedTriangles += frame.refine.refinedTriangles;
    sum.refine.smoothEdges += frame.refine.smoothEdges;
    sum.refine.cappedEdges += frame.refine.cappedEdges;
  }
};

std::string statisticsJson(const Totals& t, const WriterTimes& writer, const RenderOptions& options) {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const raster::Statistics& r = t.sum.raster;
  nlohmann::ordered_json json;
  json["limn"] = LIMN_VERSION;
  json["threads"] = options.threads;
  json["frames"] = {{"drawn", t.drawn},
                    {"skipped", t.skipped},
                    {"per_second", t.totalMs > 0 ? 1000.0 * t.drawn / t.totalMs : 0.0}};
  json["counts"] = {{"triangles_in", r.trianglesIn},
                    {"triangles_drawn", r.trianglesDrawn},
                    {"curved_triangles", t.sum.refine.curvedTriangles},
                    {"refined_triangles", t.sum.refine.refinedTriangles},
                    {"smooth_edges", t.sum.refine.smoothEdges},
                    {"capped_edges", t.sum.refine.cappedEdges},
                    {"pixels_covered", r.pixelsCovered},
                    {"pixels_shaded", r.pixelsShaded},
                    {"bytes_written", writer.bytes}};
  json["milliseconds"] = {
      {"load", t.loadMs},          {"prepare", t.prepareMs},  {"pose", t.poseMs},
      {"refine", t.refineMs},      {"raster", t.rasterMs},    {"hash", writer.hashMs},
      {"encode", writer.encodeMs}, {"write", writer.writeMs}, {"frames_total", t.totalMs}};
  json["raster_thread_milliseconds"] = {{"transform", r.transformMs}, {"setup", r.setupMs},
                                        {"binning", r.binningMs},     {"visibility", r.visibilityMs},
                                        {"shading", r.shadingMs},     {"resolve", r.resolveMs}};
  json["memory"] = {{"peak_bytes", usage.ru_maxrss * 1024L}, {"raster_scratch_bytes", r.scratchBytes}};
  return json.dump(2) + "\n";
}

void listFrames(const Selection& selection, const OutputPattern* pattern) {
  for (int i = 0; i < selection.count(); ++i) {
    const int frame = selection.frame(i);
    std::cout << frame << ' '
              << (pattern == nullptr            ? ""
                  : pattern->isStandardOutput() ? "-"
                                                : pattern->path(frame))
              << '\n';
  }
  std::cout << std::flush;
}

void writeText(const std::string& path, const std::string& text) {
  scene::makeDirectoriesOf(path);
  scene::writeFileWhole(path, text.data(), text.size());
}

Manifest manifestOf(const Job& job, const Selection& selection, const RenderOptions& options,
                    const FrameWriter& writer) {
  Manifest manifest;
  manifest.job = job.text();
  manifest.list = selection.list().text();
  manifest.shard = options.shard;
  manifest.rgba = options.rgba;
  manifest.width = options.job.width;
  manifest.height = options.job.height;
  for (const Aov aov : options.aovs) manifest.aovs.push_back(aovName(aov));
  manifest.frames = writer.records();
  return manifest;
}

/// All directories of the run's files, now: one that is lost later on is a fault.
void makeDirectories(const OutputPattern& pattern, const Selection& selection) {
  std::string last;
  for (int i = 0; i < selection.count(); ++i) {
    const std::string path = pattern.path(selection.frame(i));
    const std::string directory = path.substr(0, path.rfind('/') + 1);
    if (i > 0 && directory == last) continue;
    scene::makeDirectoriesOf(path);
    last = directory;
  }
}

/// Draws frame after frame while earlier ones are finished.
void drawFrames(const scene::Scene& scene, const Job& job, const Selection& selection,
                const RenderOptions& options, FrameWriter& writer, Totals& totals) {
  scene::FrameDrawer drawer(scene, options.threads);
  const std::size_t bytes = bytesPerPixel(options.aovs) * static_cast<std::size_t>(options.job.width) *
                            static_cast<std::size_t>(options.job.height);
  Pipeline pipeline(options.threads, bytes, [&](Picture& picture) { writer.finish(picture); });
  Progress progress(selection.count(), options.quiet);
  scene::Pose pose;
  scene::FrameStatistics statistics;
  for (int position = 0; position < selection.count(); ++position) {
    std::unique_ptr<Picture> picture = pipeline.acquire();
    picture->position = position;
    picture->frame = selection.frame(position);
    picture->existing = options.skipExisting && writer.isThere(*picture);
    if (picture->existing) {
      ++totals.skipped;
    } else {
      const Clock::time_point start = Clock::now();
      job.pose(picture->frame, pose, &drawer.workers());
      totals.poseMs += millisecondsSince(start);
      const scene::CameraView camera = job.camera(picture->frame, pose);
      picture->projection = camera.projection;
      wantPlanes(options.aovs, picture->planes);
      drawer.draw(pose, camera, job.settings(picture->frame), picture->image, &statistics, &picture->planes);
      totals.add(statistics);
    }
    pipeline.submit(std::move(picture));
    progress.show(position + 1, totals.skipped);
  }
  pipeline.drain();
}

}  // namespace

int render(const RenderOptions& options) {
  checkOutput(options);
  std::optional<OutputPattern> pattern;
  if (options.output) pattern.emplace(*options.output);

  Totals totals;
  Clock::time_point start = Clock::now();
  const scene::Scene scene = scene::load(options.job.model, {options.job.creaseDegrees});
  totals.loadMs = millisecondsSince(start);
  if (!options.quiet)
    for (const std::string& notice : scene.notices) printMessage("note: " + notice);

  start = Clock::now();
  const Job job = makeJob(scene, options.job);
  const Selection selection(options, job.frameCount());
  if (pattern && !pattern->hasNumber() && !pattern->isStandardOutput() && selection.list().count() > 1)
    throw UsageError(std::to_string(selection.list().count()) + " frames do not fit into one file '" +
                     *options.output + "'; give a pattern like frames/%04d.png");
  requireOwnFiles(options, pattern ? &*pattern : nullptr, selection);
  if (options.dryRun) requireWritableFiles(options, pattern ? &*pattern : nullptr, selection);
  totals.prepareMs = millisecondsSince(start);

  if (options.dryRun && !options.hash) {
    listFrames(selection, pattern ? &*pattern : nullptr);
    return kDone;
  }
  const bool writes = pattern && !options.dryRun;
  if (writes && !pattern->isStandardOutput()) makeDirectories(*pattern, selection);
  FrameWriter writer(job, options, writes ? &*pattern : nullptr, selection.count(), drawnTriangles(scene));
  start = Clock::now();
  drawFrames(scene, job, selection, options, writer, totals);
  totals.totalMs = millisecondsSince(start);

  if (options.dryRun) return kDone;
  if (options.statistics) writeText(*options.statistics, statisticsJson(totals, writer.times(), options));
  if (options.manifest) writeText(*options.manifest, manifestOf(job, selection, options, writer).json());
  return kDone;
}

}  // namespace limn::program
