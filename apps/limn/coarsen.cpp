// limn coarsen: from a fine model to a small one with the same outline.
#include <unistd.h>

#include "apps/coarsen/coarsen.h"

#include <cstdio>

#include "apps/coarsen/document.h"
#include "apps/limn/commands.h"
#include "apps/limn/terminal.h"
#include "apps/limn/values.h"
#include "apps/scene/load.h"
#include "apps/scene/output_file.h"

namespace limn::program {
namespace {

void checkOptions(const CoarsenOptions& o) {
  const int ways = (o.triangles ? 1 : 0) + (o.coarse ? 1 : 0) + (o.error ? 1 : 0);
  if (ways == 0)
    throw UsageError("say how small: --triangles N, --error PX, or --coarse FILE for a mesh of your own");
  if (ways > 1) throw UsageError("--triangles, --error and --coarse exclude each other; name one");
  if (o.at && !o.error)
    throw UsageError("--at: says in which window --error counts pixels; give --error, too");
  if (o.output == "-" && ::isatty(STDOUT_FILENO) == 1)
    throw UsageError("-o - would print a GLB on the terminal; name a file or a pipe");
}

/// Where each mesh's share of the progress begins, by triangles.
std::vector<double> progressOf(const std::vector<scene::Mesh>& meshes) {
  std::vector<double> from = {0.0};
  for (const scene::Mesh& mesh : meshes)
    from.push_back(from.back() + static_cast<double>(mesh.indices.size()));
  for (double& part : from) part /= std::max(1.0, from.back());
  return from;
}

/// What there is to say of all meshes together.
struct Summary {
  std::size_t fine = 0, coarse = 0, mended = 0, straightened = 0;

  void add(const coarsen::Report& report, const scene::Mesh& mesh) {
    fine += report.fineTriangles;
    coarse += mesh.indices.size() / 3;
    mended += report.guard.mended;
    straightened += report.guard.straightened;
  }
};

class Coarsening {
 public:
  explicit Coarsening(const CoarsenOptions& options)
      : options_(options), workers_(options.threads), progress_(0, options.quiet) {}

  std::vector<std::uint8_t> run() {
    const scene::Source fine = open(options_.fine);
    if (!options_.coarse) {
      std::vector<scene::Mesh> meshes;
      for (std::size_t m = 0; m < fine.scene.meshes.size(); ++m) meshes.push_back(smaller(fine, m));
      return coarsen::withMeshes(fine, meshes);
    }
    scene::Source coarse = open(*options_.coarse);
    if (coarse.scene.meshes.size() != fine.scene.meshes.size())
      throw scene::InputError(*options_.coarse + ": has " + std::to_string(coarse.scene.meshes.size()) +
                              " meshes, " + options_.fine + " has " +
                              std::to_string(fine.scene.meshes.size()) +
                              "; the two must hold the same meshes in the same order");
    for (std::size_t m = 0; m < coarse.scene.meshes.size(); ++m) {
      scene::Mesh& mesh = coarse.scene.meshes[m];
      if (mesh.indices.empty() || fine.scene.meshes[m].indices.empty()) continue;
      coarsen::Report report;
      coarsen::fitMesh(fine.scene.meshes[m], mesh, workers_, &report, part(fine, m));
      summary.add(report, mesh);
    }
    return coarsen::withCurves(coarse, coarse.scene.meshes);
  }

  Summary summary;

 private:
  scene::Source open(const std::string& model) {
    scene::Source source = scene::openSource(model);
    std::size_t triangles = 0;
    for (const scene::Mesh& mesh : source.scene.meshes) triangles += mesh.indices.size() / 3;
    if (triangles == 0)
      throw scene::InputError(source.file.name + ": holds no triangles; name a model that does");
    if (!options_.quiet)
      for (const std::string& notice : source.scene.notices) printMessage(source.file.name + ": " + notice);
    return source;
  }

  scene::Mesh smaller(const scene::Source& fine, std::size_t m) {
    const scene::Mesh& mesh = fine.scene.meshes[m];
    if (mesh.indices.empty()) return mesh;
    coarsen::Report report;
    std::optional<scene::Mesh> small;
    if (options_.error) {
      const auto [width, height] = options_.at.value_or(std::pair(1280, 800));
      small =
          coarsen::coarsenWithin(mesh, {*options_.error, width, height}, workers_, &report, part(fine, m));
      if (!small)
        throw UsageError("--error: " + numberText(*options_.error) + " pixels take as many triangles as " +
                         options_.fine + " has; allow more");
    } else {
      const std::size_t share = coarsen::shareTriangles(fine.scene.meshes, *options_.triangles)[m];
      small = coarsen::coarsenMesh(mesh, {share}, workers_, &report, part(fine, m));
    }
    summary.add(report, *small);
    return *std::move(small);
  }

  coarsen::Progress part(const scene::Source& fine, std::size_t mesh) {
    const std::vector<double> from = progressOf(fine.scene.meshes);
    return [this, first = from[mesh], next = from[mesh + 1]](double done) {
      progress_.showPart(first + (next - first) * done);
    };
  }

  const CoarsenOptions& options_;
  Workers workers_;
  Progress progress_;
};

}  // namespace

int coarsen(const CoarsenOptions& options) {
  checkOptions(options);
  std::vector<std::uint8_t> file;
  Summary summary;
  {
    Coarsening coarsening(options);
    file = coarsening.run();
    summary = coarsening.summary;
  }
  if (options.output == "-") {
    scene::writeAll(STDOUT_FILENO, "standard output", file.data(), file.size());
  } else {
    scene::makeDirectoriesOf(options.output);
    scene::writeFileWhole(options.output, file.data(), file.size());
  }
  if (!options.quiet)
    printMessage(std::to_string(summary.fine) + " triangles to " + std::to_string(summary.coarse) + ", " +
                 std::to_string(file.size()) + " bytes; " + std::to_string(summary.mended) +
                 " patches drawn back towards their triangles, " + std::to_string(summary.straightened) +
                 " left flat");
  return kDone;
}

}  // namespace limn::program
