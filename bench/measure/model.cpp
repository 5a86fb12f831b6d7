#include "bench/measure/model.h"

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "apps/scene/load.h"
#include "silhouette/topology.h"

namespace limn::measure {
namespace {

PlacedMesh placed(const scene::Mesh& mesh, const scene::Instance& instance) {
  const auto& positions = instance.deformed() ? instance.positions : mesh.positions;
  const auto& normals = instance.deformed() ? instance.normals : mesh.normals;
  const glm::dmat3 linear(instance.toWorld);
  // The cofactor matrix is the inverse transpose without its division, and without its sign under reflection.
  const bool reflected = glm::determinant(linear) < 0.0;
  const glm::dmat3 cofactor = glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                         glm::cross(linear[0], linear[1])) *
                              (reflected ? -1.0 : 1.0);
  PlacedMesh out;
  out.offset = glm::dvec3(instance.toWorld[3]);
  for (const glm::vec3& p : positions) out.positions.emplace_back(linear * glm::dvec3(p));
  const bool rigid = linear == glm::dmat3(1.0);
  for (const glm::vec3& n : normals) {
    const glm::dvec3 turned = cofactor * glm::dvec3(n);
    const double size = glm::length(turned);
    out.normals.push_back(rigid || !(size > 0.0) ? n : glm::vec3(turned / size));
  }
  out.indices = mesh.indices;
  if (!reflected) {
    out.curves = mesh.curves;
  } else {
    for (std::size_t i = 0; i + 2 < out.indices.size(); i += 3)
      std::swap(out.indices[i + 1], out.indices[i + 2]);
  }
  return out;
}

void append(Surface& surface, std::span<const glm::vec3> positions, const glm::dvec3& offset) {
  for (const glm::vec3& p : positions) surface.positions.push_back(glm::dvec3(p) + offset);
}

}  // namespace

std::vector<PlacedMesh> loadMeshes(const std::string& model) {
  const scene::Scene scene = scene::load(model);
  scene::Pose pose;
  scene::evaluatePose(scene, -1, 0.0, pose);
  std::vector<PlacedMesh> meshes;
  for (const scene::Instance& instance : pose.instances)
    meshes.push_back(placed(scene.meshes[instance.mesh], instance));
  if (meshes.empty()) throw scene::InputError(model + ": draws nothing");
  return meshes;
}

Surface surfaceOf(std::span<const PlacedMesh> meshes) {
  Surface surface;
  for (const PlacedMesh& mesh : meshes) {
    const auto base = static_cast<std::uint32_t>(surface.positions.size());
    append(surface, mesh.positions, mesh.offset);
    for (const std::uint32_t index : mesh.indices) surface.indices.push_back(base + index);
  }
  return surface;
}

namespace {

bool isBuiltin(const std::string& model) {
  return model.starts_with("builtin:");
}

// The fine mesh beside a coarse one: NAME-fine for NAME-COUNT.
std::string fineBeside(const std::filesystem::path& model) {
  const std::string stem = model.stem().string();
  const std::size_t dash = stem.rfind('-');
  if (dash == std::string::npos) return {};
  const std::filesystem::path fine =
      model.parent_path() / (stem.substr(0, dash) + "-fine" + model.extension().string());
  return fine != model && std::filesystem::exists(fine) ? fine.string() : std::string();
}

}  // namespace

Pair makePair(const std::string& model, const std::string& truth) {
  Pair pair{model, truth, isBuiltin(model) ? model : std::filesystem::path(model).stem().string()};
  if (pair.truth.empty() && model == "builtin:pawn") pair.truth = "builtin:pawn:384:24";
  if (pair.truth.empty() && !isBuiltin(model)) pair.truth = fineBeside(model);
  if (pair.truth.empty()) pair.truth = "analytic";
  pair.analytic = pair.truth == "analytic" || isBuiltin(pair.truth);
  return pair;
}

std::vector<Pair> standardPairs(const std::string& modelsFolder) {
  std::vector<Pair> pairs;
  for (const char* name : {"sphere-200", "icosphere-320", "torus-576", "knot-480", "cone-70", "pawn"}) {
    pairs.push_back(makePair(std::string("builtin:") + name, ""));
  }
  const std::filesystem::path folder = std::filesystem::path(modelsFolder) / "coarse-and-fine";
  if (!std::filesystem::is_directory(folder)) return pairs;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".glb" && !stem.ends_with("-fine"))
      files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) pairs.push_back(makePair(file, ""));
  return pairs;
}

Subject loadSubject(const Pair& pair) {
  Subject subject{pair, loadMeshes(pair.model), {}, {}, 0.0, {}};
  subject.flat = surfaceOf(subject.meshes);
  if (pair.truth == "analytic") {
    AnalyticSurface analytic = recognizeAnalytic(subject.flat);
    subject.truth = std::move(analytic.surface);
    subject.truthError = analytic.error;
  } else {
    subject.truth = surfaceOf(loadMeshes(pair.truth));
  }
  subject.bounds = boundingSphere(subject.truth);
  return subject;
}

struct ModelRefiner::Part {
  const PlacedMesh& placed;
  silhouette::Mesh shape;
  silhouette::Topology topology;
  scene::DecodedCurves curves;
  silhouette::Refiner refiner;
  silhouette::RefinedStream stream;

  Part(const PlacedMesh& mesh, Workers& workers)
      : placed(mesh),
        shape(mesh.shape()),
        topology(shape),
        curves(scene::decode(mesh.curves, shape, topology)),
        refiner(shape, topology, workers, curves.view()) {}
};

ModelRefiner::ModelRefiner(const std::vector<PlacedMesh>& meshes, Workers& workers) {
  for (const PlacedMesh& mesh : meshes) parts_.push_back(std::make_unique<Part>(mesh, workers));
}

ModelRefiner::~ModelRefiner() = default;

void ModelRefiner::refine(const scene::CameraView& camera, const silhouette::Parameters& parameters,
                          Surface& drawn) {
  drawn.positions.clear();
  drawn.indices.clear();
  for (const auto& part : parts_) {
    const auto& [placed, shape, topology, curves, refiner, stream] = *part;
    glm::dmat4 modelToView = camera.worldToView;
    modelToView[3] = camera.worldToView * glm::dvec4(placed.offset, 1.0);
    part->refiner.refine(silhouette::makeView(camera.projection, modelToView), parameters, part->stream);
    const auto base = static_cast<std::uint32_t>(drawn.positions.size());
    append(drawn, placed.positions, placed.offset);
    append(drawn, stream.positions, placed.offset);
    for (std::size_t t = 0; t < shape.triangleCount(); ++t) {
      if (stream.isReplaced(t)) continue;
      for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) drawn.indices.push_back(base + placed.indices[k]);
    }
    for (const std::uint32_t index : stream.indices) drawn.indices.push_back(base + index);
  }
}

}  // namespace limn::measure
