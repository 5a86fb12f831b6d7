// A coarse model, what it stands for, and its refinement for a view: what the measures are taken on.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/scene/camera.h"
#include "apps/scene/stored_curves.h"
#include "bench/measure/surface.h"
#include "raster/base/workers.h"
#include "silhouette/refine.h"

namespace limn::measure {

/// One mesh of a scene as it stands in the world: placed but for `offset`, so that floats serve.
struct PlacedMesh {
  glm::dvec3 offset{0.0};
  std::vector<glm::vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  scene::StoredCurves curves;  ///< fitted beforehand, or empty; mirrored instances are measured without

  silhouette::Mesh shape() const { return {positions, normals, indices}; }
};

/// The rest pose of a model as limn::scene::load names it.
std::vector<PlacedMesh> loadMeshes(const std::string& model);

/// Their triangles in world space.
Surface surfaceOf(std::span<const PlacedMesh> meshes);

/// A coarse model and the truth that it is measured against.
struct Pair {
  std::string model;  ///< for limn::scene::load
  std::string truth;  ///< likewise, or "analytic"
  std::string name;   ///< in the rows: built-in models with "builtin:", files without folder and extension
  bool analytic = false;  ///< the truth is a formula (known to rounding), not a mesh that somebody modelled
};

/// A pair for `--model` and `--truth`; an empty truth is looked up: analytic for the built-in shapes, the
/// fine mesh that lies beside a coarse one (NAME-fine for NAME-500), else analytic.
Pair makePair(const std::string& model, const std::string& truth);

/// All built-in models, and the pairs of coarse-and-fine/ in `modelsFolder` where it is there.
std::vector<Pair> standardPairs(const std::string& modelsFolder);

/// A pair in memory.
struct Subject {
  Pair pair;
  std::vector<PlacedMesh> meshes;
  Surface flat, truth;
  double truthError = 0.0;  ///< of an analytic truth's tessellation, world units
  scene::Sphere bounds;     ///< of the truth
};
Subject loadSubject(const Pair& pair);

/// Refines all meshes of a model for one view after the other.
class ModelRefiner {
 public:
  ModelRefiner(const std::vector<PlacedMesh>& meshes, Workers& workers);
  ~ModelRefiner();

  /// What is drawn for this view, in world space.
  void refine(const scene::CameraView& camera, const silhouette::Parameters& parameters, Surface& drawn);

 private:
  struct Part;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace limn::measure
