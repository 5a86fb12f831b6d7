// One frame as a straight line: place → refine → attributes → draws → rasterize.
#include "apps/scene/frame.h"

#include <chrono>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <vector>

#include "apps/scene/lights.h"
#include "raster/base/check.h"
#include "raster/base/workers.h"
#include "silhouette/topology.h"

namespace limn::scene {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What a mesh of the scene keeps for as long as the scene is drawn.
struct MeshResources {
  silhouette::Mesh shape;
  silhouette::Topology topology;
  raster::Geometry geometry;
  silhouette::Refiner refiner;

  MeshResources(const Mesh& mesh, Workers& workers)
      : shape{mesh.positions, mesh.normals, mesh.indices},
        topology(shape),
        geometry({mesh.positions, mesh.normals, mesh.texcoords, mesh.colors, mesh.tangents}, mesh.indices,
                 mesh.parts),
        refiner(shape, topology, workers) {}
};

/// What an instance keeps from frame to frame: its stream, and arrays of its own where it does not merely
/// move.
struct InstanceResources {
  std::optional<silhouette::Refiner> refiner;  ///< of a deformed or non-uniformly scaled instance
  std::vector<glm::vec3> positions,
      normals;  ///< of a non-uniformly scaled one, placed but for the translation
  std::vector<glm::vec4> tangents;
  silhouette::RefinedStream stream;
  std::vector<glm::vec2> texcoords;  ///< of the stream's vertices
  std::vector<glm::vec4> colors, streamTangents;
  silhouette::RefineReport report;
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

/// Applies the linear part of a placement that is no similarity, so that normals and edge curves are those of
/// the scaled surface.
void placeLinearly(const glm::dmat3& linear, std::span<const glm::vec3> positions,
                   std::span<const glm::vec3> normals, std::span<const glm::vec4> tangents,
                   InstanceResources& out) {
  // The cofactor matrix is the inverse transpose without its division; a reflection flips it, which the
  // winding of the reflected triangles does not want.
  const double sign = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
  const glm::dmat3 cofactor(sign * glm::cross(linear[1], linear[2]), sign * glm::cross(linear[2], linear[0]),
                            sign * glm::cross(linear[0], linear[1]));
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
  out.clear();
  if (attribute.empty()) return;
  out.reserve(origins.size());
  for (const silhouette::Origin& origin : origins) {
    const std::uint32_t* corner = &mesh.indices[3 * std::size_t{origin.triangle}];
    const float w1 = origin.weights.x, w2 = origin.weights.y;
    out.push_back(attribute[corner[0]] * (1.0f - w1 - w2) + attribute[corner[1]] * w1 +
                  attribute[corner[2]] * w2);
  }
}

}  // namespace

struct FrameDrawer::State {
  const Scene& scene;
  Workers workers;
  raster::Renderer renderer;
  std::vector<std::unique_ptr<MeshResources>> meshes;
  std::vector<InstanceResources> instances;
  std::vector<raster::Draw> draws;
  std::vector<raster::Light> lights;

  State(const Scene& drawn, int threads) : scene(drawn), workers(threads), renderer(threads) {
    meshes.resize(scene.meshes.size());
  }

  MeshResources& mesh(std::uint32_t index) {
    std::unique_ptr<MeshResources>& resources = meshes[index];
    if (!resources) resources = std::make_unique<MeshResources>(scene.meshes[index], workers);
    return *resources;
  }

  raster::Draw prepare(const Instance& instance, const CameraView& camera,
                       const silhouette::Parameters& parameters, InstanceResources& out);
};

/// Refines one instance for the camera and says how to draw it.
raster::Draw FrameDrawer::State::prepare(const Instance& instance, const CameraView& camera,
                                         const silhouette::Parameters& parameters, InstanceResources& out) {
  const Mesh& source = scene.meshes[instance.mesh];
  MeshResources& shared = mesh(instance.mesh);
  const glm::dmat3 linear(instance.toWorld);
  const bool similar = isSimilarity(linear);

  glm::dmat4 modelToView = camera.worldToView * instance.toWorld;
  silhouette::Mesh shape = shared.shape;
  std::span<const glm::vec4> tangents = source.tangents;
  if (instance.deformed()) {
    shape.positions = instance.positions;
    shape.normals = instance.normals;
    tangents = instance.tangents;
  }
  if (!similar) {
    placeLinearly(linear, shape.positions, shape.normals, tangents, out);
    shape.positions = out.positions;
    shape.normals = out.normals;
    tangents = out.tangents;
    glm::dmat4 translation(1.0);
    translation[3] = instance.toWorld[3];
    modelToView = camera.worldToView * translation;
  }
  const bool ownShape = instance.deformed() || !similar;
  if (ownShape) {
    if (!out.refiner) out.refiner.emplace(shape, shared.topology, workers);
    out.refiner->deform(shape);
  }
  silhouette::Refiner& refiner = ownShape ? *out.refiner : shared.refiner;

  const silhouette::View view = silhouette::makeView(camera.projection, modelToView);
  refiner.refine(view, parameters, out.stream, &out.report);
  interpolate<glm::vec2>(source, out.stream.origins, source.texcoords, out.texcoords);
  interpolate<glm::vec4>(source, out.stream.origins, source.colors, out.colors);
  interpolate<glm::vec4>(source, out.stream.origins, tangents, out.streamTangents);

  raster::Draw draw;
  draw.geometry = &shared.geometry;
  draw.replaced = out.stream.replaced;
  draw.stream = {{out.stream.positions, out.stream.normals, out.texcoords, out.colors, out.streamTangents},
                 out.stream.indices,
                 out.stream.sourceTriangles};
  if (ownShape) {
    draw.posedPositions = shape.positions;
    draw.posedNormals = shape.normals;
    draw.posedTangents = tangents;
  }
  draw.modelToView = view.modelToView;
  return draw;
}

FrameDrawer::FrameDrawer(const Scene& scene, int threads) : state_(std::make_unique<State>(scene, threads)) {}
FrameDrawer::~FrameDrawer() = default;

void FrameDrawer::draw(const Pose& pose, const CameraView& camera, const FrameSettings& settings,
                       Image& image, FrameStatistics* statistics) {
  const Clock::time_point start = Clock::now();
  State& s = *state_;
  s.instances.resize(pose.instances.size());
  s.draws.clear();

  std::uint32_t firstId = 0;
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    s.draws.push_back(s.prepare(pose.instances[i], camera, settings.refinement, s.instances[i]));
    s.draws.back().firstId = firstId;
    firstId += static_cast<std::uint32_t>(s.scene.meshes[pose.instances[i].mesh].indices.size() / 3);
  }
  viewLights(s.scene, pose, camera, settings, s.lights);
  const double refineMs = millisecondsSince(start);

  image.width = camera.projection.width;
  image.height = camera.projection.height;
  image.rgba.resize(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));

  raster::Frame frame;
  frame.projection = camera.projection;
  frame.draws = s.draws;
  frame.materials = s.scene.materials;
  frame.lights = s.lights;
  frame.encoding = settings.encoding;
  frame.background = settings.background;
  frame.samples = settings.samples;
  raster::Target target;
  target.rgba = image.rgba.data();
  target.rgbaStride = 4 * static_cast<std::size_t>(image.width);
  const Clock::time_point rasterStart = Clock::now();
  s.renderer.draw(frame, target, statistics ? &statistics->raster : nullptr);

  if (!statistics) return;
  statistics->refine = {};
  for (const InstanceResources& instance : s.instances) {
    statistics->refine.curvedTriangles += instance.report.curvedTriangles;
    statistics->refine.refinedTriangles += instance.report.refinedTriangles;
    statistics->refine.smoothEdges += instance.report.smoothEdges;
    statistics->refine.cappedEdges += instance.report.cappedEdges;
    statistics->refine.classifyMs += instance.report.classifyMs;
    statistics->refine.refineMs += instance.report.refineMs;
  }
  statistics->refineMs = refineMs;
  statistics->rasterMs = millisecondsSince(rasterStart);
  statistics->totalMs = millisecondsSince(start);
}

const silhouette::RefinedStream& FrameDrawer::stream(std::size_t instance) const {
  require(instance < state_->instances.size(), "no such instance in the last frame");
  return state_->instances[instance].stream;
}

}  // namespace limn::scene
