// One frame as a straight line: place → refine → attributes → draws → rasterize.
#include "apps/scene/frame.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene/lights.h"
#include "apps/scene/load.h"
#include "raster/base/check.h"
#include "raster/base/workers.h"
#include "silhouette/topology.h"

namespace limn::scene {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What smoothing a mesh takes, made for the first frame that is not flat: far more memory than the mesh itself.
struct Smoothing {
  silhouette::Topology topology;
  DecodedCurves curves;
  silhouette::Refiner refiner;

  Smoothing(const Mesh& mesh, const silhouette::Mesh& shape, Workers& workers)
      : topology(shape),
        curves(decode(mesh.curves, shape, topology)),
        refiner(shape, topology, workers, curves.view()) {}
};

/// What a mesh of the scene keeps for as long as the scene is drawn.
struct MeshResources {
  silhouette::Mesh shape;
  raster::Geometry geometry;
  std::unique_ptr<Smoothing> smoothing;

  /// Borrows the mesh's arrays.
  explicit MeshResources(const Mesh& mesh)
      : shape{mesh.positions, mesh.normals, mesh.indices},
        geometry({mesh.positions, mesh.normals, mesh.texcoords, mesh.colors, mesh.tangents}, mesh.indices,
                 mesh.parts, raster::Geometry::Keep::kReferences) {}
};

/// What an instance keeps from frame to frame: its stream, and arrays of its own where it does not merely
/// move.
struct InstanceResources {
  std::optional<silhouette::Refiner> refiner;  ///< of a deformed or non-uniformly scaled instance
  std::vector<glm::vec3> positions,
      normals;  ///< of a non-uniformly scaled one, placed but for the translation
  std::vector<glm::vec4> tangents;
  silhouette::Mesh shape;  ///< as it is refined and drawn this frame
  std::span<const glm::vec4> shapeTangents;
  bool ownShape = false;  ///< other positions and normals than the mesh of the scene
  glm::dmat4 shapeToWorld{1.0};
  std::uint32_t mesh = 0;
  std::size_t task = 0;  ///< of the refinement, while visible
  bool visible = false;
  silhouette::RefinedStream stream;
  std::vector<glm::vec2> texcoords;  ///< of the stream's vertices
  std::vector<glm::vec4> colors, streamTangents;
};

/// Rotation and uniform scale, reflections included: edge curves commute with it, so model space serves.
bool isSimilarity(const glm::dmat3& linear) {
  const double xx = glm::dot(linear[0], linear[0]);
  const double tolerance = 1e-5 * xx;
  return std::abs(glm::dot(linear[1], linear[1]) - xx) <= tolerance &&
         std::abs(glm::dot(linear[2], linear[2]) - xx) <= tolerance &&
         std::abs(glm::dot(linear[0], linear[1])) <= tolerance &&
         std::abs(glm::dot(linear[0], linear[2])) <= tolerance &&
         std::abs(glm::dot(linear[1], linear[2])) <= tolerance;
}

glm::vec3 unit(const glm::dvec3& v, const glm::vec3& otherwise) {
  const double square = glm::dot(v, v);
  return square > 0.0 ? glm::vec3(v / std::sqrt(square)) : otherwise;
}

/// Applies the linear part of a placement that is no similarity (and no reflection), so that normals and edge curves
/// are those of the scaled surface.
void placeLinearly(const glm::dmat3& linear, std::span<const glm::vec3> positions,
                   std::span<const glm::vec3> normals, std::span<const glm::vec4> tangents,
                   InstanceResources& out) {
  // The cofactor matrix is the inverse transpose without its division.
  const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
  out.positions.resize(positions.size());
  out.normals.resize(normals.size());
  out.tangents.resize(tangents.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    out.positions[i] = glm::vec3(linear * glm::dvec3(positions[i]));
  for (std::size_t i = 0; i < normals.size(); ++i)
    out.normals[i] = unit(cofactor * glm::dvec3(normals[i]), normals[i]);
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const glm::vec3 tangent(tangents[i]);
    out.tangents[i] = glm::vec4(unit(linear * glm::dvec3(tangent), tangent), tangents[i].w);
  }
}

/// Linear interpolation of a vertex attribute at the stream's new vertices.
template <class T>
void interpolate(const Mesh& mesh, const std::vector<silhouette::Origin>& origins,
                 std::span<const T> attribute, std::vector<T>& out) {
  out.resize(attribute.empty() ? 0 : origins.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t* corner = &mesh.indices[3 * std::size_t{origins[i].triangle}];
    const float w1 = origins[i].weights.x, w2 = origins[i].weights.y;
    out[i] = attribute[corner[0]] * (1.0f - w1 - w2) + attribute[corner[1]] * w1 + attribute[corner[2]] * w2;
  }
}

}  // namespace

struct FrameDrawer::State {
  const Scene& scene;
  Workers workers;
  raster::Renderer renderer;
  std::vector<std::unique_ptr<MeshResources>> meshes;
  std::vector<InstanceResources> instances;
  std::vector<silhouette::RefineTask> tasks;
  std::vector<raster::Draw> draws;
  std::vector<raster::Light> lights;
  OverlayLines overlays;
  std::vector<float> alphas;          ///< of the instance whose overlay is being added
  silhouette::Parameters parameters;  ///< of the last frame

  State(const Scene& drawn, int threads, const raster::Tuning& tuning)
      : scene(drawn), workers(threads), renderer(threads, tuning) {
    meshes.resize(scene.meshes.size());
  }

  MeshResources& mesh(std::uint32_t index) {
    std::unique_ptr<MeshResources>& resources = meshes[index];
    if (!resources) resources = std::make_unique<MeshResources>(scene.meshes[index]);
    return *resources;
  }

  /// Sets up what the frame needs of every instance, and refines them where `smooth`.
  void refine(const Pose& pose, const CameraView& camera, const FrameSettings& settings, bool smooth);
  void place(const Instance& instance, const CameraView& camera, InstanceResources& out);
  silhouette::Refiner* refinerOf(MeshResources& shared, InstanceResources& instance);
  raster::Draw describe(const Instance& instance, const InstanceResources& resources) const;
  RefinedInstance refined(const InstanceResources& resources) const;
  void refineWithinLimit();
  void addOverlays(const OverlaySet& wanted);
  [[noreturn]] void refuse(const raster::TooMuchEffort& error, double limit) const;
};

/// Finds where the instance's shape is and how the camera sees it.
void FrameDrawer::State::place(const Instance& instance, const CameraView& camera, InstanceResources& out) {
  const Mesh& source = scene.meshes[instance.mesh];
  MeshResources& shared = mesh(instance.mesh);
  out.shape = shared.shape;
  out.shapeTangents = source.tangents;
  if (instance.deformed()) {
    out.shape.positions = instance.positions;
    out.shape.normals = instance.normals;
    out.shapeTangents = instance.tangents;
  }

  glm::dmat4& shapeToWorld = out.shapeToWorld;
  shapeToWorld = instance.toWorld;
  const glm::dmat3 linear(instance.toWorld);
  const bool similar = isSimilarity(linear);
  if (!similar) {
    // toWorld = translation · mirror · (mirror · linear): what is applied here keeps the outside outside.
    const glm::dmat3 mirror = glm::dmat3(glm::dvec3(glm::determinant(linear) < 0.0 ? -1.0 : 1.0, 0.0, 0.0),
                                         glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0));
    placeLinearly(mirror * linear, out.shape.positions, out.shape.normals, out.shapeTangents, out);
    out.shape.positions = out.positions;
    out.shape.normals = out.normals;
    out.shapeTangents = out.tangents;
    shapeToWorld = glm::dmat4(mirror);
    shapeToWorld[3] = instance.toWorld[3];
  }
  out.ownShape = instance.deformed() || !similar;
  out.mesh = instance.mesh;
  out.task = tasks.size();
  tasks.push_back(
      {nullptr, silhouette::makeView(camera.projection, camera.worldToView * shapeToWorld), &out.stream, {}});
}

/// The refiner of the instance's shape.
silhouette::Refiner* FrameDrawer::State::refinerOf(MeshResources& shared, InstanceResources& instance) {
  if (!shared.smoothing)
    shared.smoothing = std::make_unique<Smoothing>(scene.meshes[instance.mesh], shared.shape, workers);
  Smoothing& smoothing = *shared.smoothing;
  if (!instance.ownShape) return &smoothing.refiner;
  if (!instance.refiner)
    instance.refiner.emplace(instance.shape, smoothing.topology, workers, smoothing.curves.view());
  instance.refiner->deform(instance.shape);
  return &*instance.refiner;
}

raster::Draw FrameDrawer::State::describe(const Instance& instance,
                                          const InstanceResources& resources) const {
  raster::Draw draw;
  draw.geometry = &meshes[instance.mesh]->geometry;
  draw.replaced = resources.stream.replaced;
  draw.stream = {{resources.stream.positions, resources.stream.normals, resources.texcoords, resources.colors,
                  resources.streamTangents},
                 resources.stream.indices,
                 resources.stream.sourceTriangles};
  if (resources.ownShape) {
    draw.posedPositions = resources.shape.positions;
    draw.posedNormals = resources.shape.normals;
    draw.posedTangents = resources.shapeTangents;
  }
  return draw;
}

RefinedInstance FrameDrawer::State::refined(const InstanceResources& resources) const {
  const Smoothing* smoothing = meshes[resources.mesh]->smoothing.get();
  return {resources.shape,          smoothing ? &smoothing->topology : nullptr,
          &resources.stream,        resources.texcoords,
          resources.colors,         resources.shapeTangents,
          resources.streamTangents, resources.shapeToWorld};
}

void FrameDrawer::State::addOverlays(const OverlaySet& wanted) {
  overlays.clear();
  // α is what patches make of the view; the other methods have none of their own.
  silhouette::Parameters classification = parameters;
  classification.method = silhouette::Method::kPatches;
  for (std::size_t overlay = 0; overlay < kOverlays; ++overlay) {
    if (!wanted[overlay]) continue;
    for (const InstanceResources& resources : instances) {
      if (!resources.visible) continue;
      const silhouette::RefineTask& task = tasks[resources.task];
      const bool isEdges = overlay == static_cast<std::size_t>(Overlay::kEdges);
      if (isEdges) task.refiner->silhouetteness(task.view, classification, alphas);
      overlays.add(static_cast<Overlay>(overlay), {refined(resources), task.view, parameters.method, alphas});
    }
  }
}

void FrameDrawer::State::refuse(const raster::TooMuchEffort& error, double limit) const {
  const auto seconds = [](double nanoseconds) { return std::to_string(std::llround(nanoseconds * 1e-9)); };
  std::size_t mesh = 0;  // of the draw: those are the visible instances in their order
  std::uint32_t left = error.heaviestDraw;
  for (const InstanceResources& resources : instances) {
    if (!resources.visible) continue;
    mesh = resources.mesh;
    if (left-- == 0) break;
  }
  throw InputError(scene.name + ": /meshes/" + std::to_string(mesh) +
                   ": to draw it in so many layers takes about " + seconds(error.effort) +
                   " seconds of a processor per frame, where a file of this size may take " + seconds(limit) +
                   "; lower the number of triangles or lights in one place, or --zoom");
}

namespace {

/// Smaller frames may take as much as one of 1280x800.
double effortLimitOf(const Scene& scene, const Projection& projection) {
  constexpr double kPixels = 1280.0 * 800.0;
  return scene.effortLimit * std::max(1.0, double(projection.width) * double(projection.height) / kPixels);
}

/// Where the picture and the planes that are wanted go, sized for it.
raster::Target targetOf(Image& image, Planes* planes) {
  const std::size_t width = static_cast<std::size_t>(image.width);
  const std::size_t pixels = width * static_cast<std::size_t>(image.height);
  raster::Target target;
  image.rgba.resize(4 * pixels);
  target.rgba = image.rgba.data();
  target.rgbaStride = 4 * width;
  if (planes == nullptr) return target;
  if (planes->wantsDepth) {
    planes->depth.resize(pixels);
    target.depth = planes->depth.data();
    target.depthStride = width;
  }
  if (planes->wantsNormals) {
    planes->normals.resize(pixels);
    target.normals = planes->normals.data();
    target.normalStride = width;
  }
  if (planes->wantsIds) {
    planes->ids.resize(pixels);
    target.ids = planes->ids.data();
    target.idStride = width;
  }
  return target;
}

}  // namespace

FrameDrawer::FrameDrawer(const Scene& scene, int threads, const raster::Tuning& tuning)
    : state_(std::make_unique<State>(scene, threads, tuning)) {}
FrameDrawer::~FrameDrawer() = default;

void FrameDrawer::State::refineWithinLimit() {
  double coarse = 0.0;
  for (const InstanceResources& resources : instances)
    if (resources.visible) coarse += static_cast<double>(resources.shape.triangleCount());
  if (std::isfinite(scene.refinedLimit))
    parameters.mostPerTriangle = static_cast<std::size_t>(scene.refinedLimit / std::max(coarse, 1.0));
  try {
    silhouette::refineAll(tasks, parameters, workers);
  } catch (const silhouette::TooManyTriangles& error) {
    if (error.limit == silhouette::TooManyTriangles::Limit::kIndices)
      throw InputError(scene.name + ": /meshes: one of them would become " + std::to_string(error.triangles) +
                       " triangles, more than 32-bit indices can number; draw it with fewer --segments or a "
                       "larger --tolerance");
    throw InputError(scene.name + ": /meshes: each of " + std::to_string(std::llround(coarse)) +
                     " triangles would become " + std::to_string(error.triangles) +
                     ", a file of this size may ask for " + std::to_string(parameters.mostPerTriangle) +
                     "; draw it with --method patches or a larger --tolerance");
  }
}

void FrameDrawer::State::refine(const Pose& pose, const CameraView& camera, const FrameSettings& settings,
                                bool smooth) {
  parameters = settings.refinement;
  parameters.listContour = settings.overlays[static_cast<std::size_t>(Overlay::kContour)];
  instances.resize(pose.instances.size());
  tasks.clear();
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    instances[i].visible = pose.instances[i].visible;
    if (!pose.instances[i].visible) continue;
    InstanceResources& resources = instances[i];
    place(pose.instances[i], camera, resources);
    if (smooth)
      tasks.back().refiner = refinerOf(mesh(resources.mesh), resources);
    else
      resources.stream.clear(resources.shape.triangleCount());
  }
  if (smooth) refineWithinLimit();

  // What the stream's vertices interpolate, instances side by side.
  workers.forBlocks(instances.size(), 1, [&](std::size_t i, std::size_t, int) {
    InstanceResources& resources = instances[i];
    if (!resources.visible) return;
    const Mesh& mesh = scene.meshes[resources.mesh];
    const std::vector<silhouette::Origin>& origins = resources.stream.origins;
    interpolate<glm::vec2>(mesh, origins, mesh.texcoords, resources.texcoords);
    interpolate<glm::vec4>(mesh, origins, mesh.colors, resources.colors);
    interpolate<glm::vec4>(mesh, origins, resources.shapeTangents, resources.streamTangents);
  });
  draws.clear();
  std::uint32_t firstId = 0;
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[pose.instances[i].mesh];
    InstanceResources& resources = instances[i];
    const std::uint32_t id = firstId;
    firstId += static_cast<std::uint32_t>(mesh.indices.size() / 3);
    if (!pose.instances[i].visible) {
      resources.stream = {};
      continue;
    }
    raster::Draw& draw = draws.emplace_back(describe(pose.instances[i], resources));
    draw.modelToView = tasks[resources.task].view.modelToView;
    draw.firstId = id;
  }
}

void FrameDrawer::refine(const Pose& pose, const CameraView& camera, const FrameSettings& settings) {
  state_->refine(pose, camera, settings, true);
}

void FrameDrawer::draw(const Pose& pose, const CameraView& camera, const FrameSettings& settings,
                       Image& image, FrameStatistics* statistics, Planes* planes) {
  const Clock::time_point start = Clock::now();
  State& s = *state_;
  const bool hasOverlays =
      std::find(settings.overlays.begin(), settings.overlays.end(), true) != settings.overlays.end();
  s.refine(pose, camera, settings, settings.refinement.method != silhouette::Method::kFlat || hasOverlays);
  viewLights(s.scene, pose, camera, settings, s.lights);
  s.addOverlays(settings.overlays);
  const double refineMs = millisecondsSince(start);

  image.width = camera.projection.width;
  image.height = camera.projection.height;
  raster::Frame frame;
  frame.projection = camera.projection;
  frame.draws = s.draws;
  frame.materials = s.scene.materials;
  frame.lights = s.lights;
  frame.lines = s.overlays.lines();
  frame.encoding = settings.encoding;
  frame.background = settings.background;
  frame.samples = settings.samples;
  frame.effortLimit = effortLimitOf(s.scene, camera.projection);
  const raster::Target target = targetOf(image, planes);
  const Clock::time_point rasterStart = Clock::now();
  try {
    s.renderer.draw(frame, target, statistics ? &statistics->raster : nullptr);
  } catch (const raster::TooMuchEffort& error) {
    s.refuse(error, frame.effortLimit);
  } catch (const std::length_error&) {
    throw InputError(s.scene.name +
                     ": /nodes: too many pieces fill too much of the picture to keep account of; draw fewer "
                     "copies in one place, or a smaller --size");
  }

  if (!statistics) return;
  statistics->refine = {};
  for (const silhouette::RefineTask& task : s.tasks) {
    statistics->refine.curvedTriangles += task.report.curvedTriangles;
    statistics->refine.refinedTriangles += task.report.refinedTriangles;
    statistics->refine.smoothEdges += task.report.smoothEdges;
    statistics->refine.cappedEdges += task.report.cappedEdges;
    statistics->refine.classifyMs += task.report.classifyMs;
    statistics->refine.refineMs += task.report.refineMs;
  }
  statistics->refineMs = refineMs;
  statistics->rasterMs = millisecondsSince(rasterStart);
  statistics->totalMs = millisecondsSince(start);
}

RefinedInstance FrameDrawer::instance(std::size_t instance) const {
  require(instance < state_->instances.size() && state_->instances[instance].visible,
          "no such instance in the last frame");
  return state_->refined(state_->instances[instance]);
}

void FrameDrawer::silhouetteness(std::size_t instance, std::vector<float>& alphas) {
  require(instance < state_->instances.size(), "no such instance in the last frame");
  const InstanceResources& resources = state_->instances[instance];
  alphas.clear();
  if (!resources.visible) return;
  const silhouette::RefineTask& task = state_->tasks[resources.task];
  if (task.refiner != nullptr) task.refiner->silhouetteness(task.view, state_->parameters, alphas);
}

Workers& FrameDrawer::workers() {
  return state_->workers;
}

}  // namespace limn::scene
