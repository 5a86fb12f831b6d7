// Whole frames at the extremes: pictures beside the ones that they should be, and streams that must stay finite.
#include <algorithm>
#include <array>
#include <functional>
#include <limits>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"
#include "bench/measure/stability.h"
#include "bench/measure/views.h"

namespace limn::measure {
namespace {

using silhouette::Method;

constexpr int kSize = 192;  // pixels a side of most pictures
constexpr std::array kMethods{Method::kFlat, Method::kPatches, Method::kCurves, Method::kPn};

silhouette::Parameters parametersOf(Method method) {
  silhouette::Parameters parameters;
  parameters.method = method;
  return parameters;
}

scene::Scene coarse() {
  return scene::load("builtin:torus-576");
}

scene::Pose rest(const scene::Scene& scene) {
  scene::Pose pose;
  scene::evaluatePose(scene, -1, 0.0, pose);
  return pose;
}

glm::dvec3 viewDirection() {
  return glm::normalize(glm::dvec3(0.3, -0.8, 0.6));
}

scene::Image draw(const scene::Scene& scene, const scene::CameraView& camera,
                  const silhouette::Parameters& parameters) {
  scene::FrameDrawer drawer(scene, 2);
  scene::FrameSettings settings;
  settings.refinement = parameters;
  settings.samples = 1;
  settings.light = scene::LightChoice::kHeadlight;
  scene::Image image;
  drawer.draw(rest(scene), camera, settings, image);
  return image;
}

double pixelsThatDiffer(const scene::Image& a, const scene::Image& b) {
  if (a.rgba.size() != b.rgba.size()) return std::numeric_limits<double>::infinity();
  double count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    if (!std::equal(a.rgba.begin() + std::ptrdiff_t(i), a.rgba.begin() + std::ptrdiff_t(i) + 4,
                    b.rgba.begin() + std::ptrdiff_t(i)))
      ++count;
  }
  return count;
}

// Most pixels that a picture of the changed scene, framed by its own bounds, has different from the plain one's.
double differenceFrom(const std::function<void(scene::Scene&)>& change,
                      const std::vector<Method>& methods = {kMethods.begin(), kMethods.end()}) {
  const scene::Scene plain = coarse();
  scene::Scene changed = coarse();
  change(changed);
  double most = 0;
  for (const Method method : methods) {
    const auto picture = [&](const scene::Scene& scene) {
      const scene::CameraView camera =
          outlineCamera(scene::boundingSphere(scene, rest(scene)), viewDirection(), kSize);
      return draw(scene, camera, parametersOf(method));
    };
    most = std::max(most, pixelsThatDiffer(picture(plain), picture(changed)));
  }
  return most;
}

double scaledBy(double factor) {
  return differenceFrom([&](scene::Scene& scene) { scene.nodes[0].scale = glm::dvec3(factor); });
}
double scaledDown() {
  return std::max(scaledBy(1e-6), scaledBy(1e-3));
}
double scaledUp() {
  return std::max(scaledBy(1e3), scaledBy(1e6));
}
double scaledByTwos() {
  return std::max(scaledBy(0x1p-20), scaledBy(0x1p20));
}
double movedFar() {
  return differenceFrom([](scene::Scene& scene) { scene.nodes[0].translation = {1e6, -1e6, 1e6}; });
}

// A million triangles without area beside the model: repeated corners, and three points in a line.
double degenerateMillion() {
  return differenceFrom([](scene::Scene& scene) {
    scene::Mesh& mesh = scene.meshes[0];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 3; ++i) {
      mesh.positions.emplace_back(0.25f * static_cast<float>(i), 0.5f, 0.0f);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
    }
    for (std::uint32_t i = 0; i < 1000000; ++i) {
      mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + (i % 3)});
    }
    mesh.parts[0].triangleCount = static_cast<std::uint32_t>(mesh.indices.size() / 3);
  });
}

// Needles without area between the model's own vertices. Not for curves: a vertex of a degenerate triangle stays where it
// is, so that the two do not come apart, and blocking (2.6) wants to move it.
double degenerateBetween() {
  return differenceFrom(
      [](scene::Scene& scene) {
        scene::Mesh& mesh = scene.meshes[0];
        const auto count = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t i = 0; i < 10 * count; ++i) {
          const std::uint32_t a = i % count, b = (i / 7) % count;
          mesh.indices.insert(mesh.indices.end(), {a, i % 3 == 0 ? a : b, b});
        }
        mesh.parts[0].triangleCount = static_cast<std::uint32_t>(mesh.indices.size() / 3);
      },
      {Method::kFlat, Method::kPatches, Method::kPn});
}

double farNear() {
  const scene::Scene scene = coarse();
  scene::CameraView camera = outlineCamera(scene::boundingSphere(scene, rest(scene)), viewDirection(), kSize);
  double most = 0;
  for (const Method method : kMethods) {
    const scene::Image usual = draw(scene, camera, parametersOf(method));
    scene::CameraView wide = camera;
    wide.projection.nearPlane = 1e-3f;
    wide.projection.farPlane = 1e4f;
    most = std::max(most, pixelsThatDiffer(usual, draw(scene, wide, parametersOf(method))));
  }
  return most;
}

bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Vertices of streams that are not finite, and streams that are not consistent, over all methods and kinds of curves.
double faults(
    const scene::Mesh& mesh, const scene::CameraView& camera,
    const std::function<void(silhouette::Parameters&)>& change = [](silhouette::Parameters&) {}) {
  const silhouette::Mesh shape{mesh.positions, mesh.normals, mesh.indices};
  const silhouette::Topology topology(shape);
  Workers workers(1);
  silhouette::Refiner refiner(shape, topology, workers);
  silhouette::RefinedStream stream;
  double count = 0;
  for (const Method method : kMethods) {
    for (const auto tangents : {silhouette::Tangents::kProjected, silhouette::Tangents::kCircular,
                                silhouette::Tangents::kGeodesic}) {
      for (const auto& [kind, robust] : {std::pair{silhouette::Silhouetteness::kCrossing, true},
                                         {silhouette::Silhouetteness::kCrossing, false},
                                         {silhouette::Silhouetteness::kEdge, true},
                                         {silhouette::Silhouetteness::kContour, false}}) {
        silhouette::Parameters parameters = parametersOf(method);
        parameters.tangents = tangents;
        parameters.silhouetteness = kind;
        parameters.robust = robust;
        change(parameters);
        refiner.refine(silhouette::makeView(camera.projection, camera.worldToView), parameters, stream);
        if (!stream.isConsistent(shape)) ++count;
        for (const glm::vec3& p : stream.positions) count += isFinite(p) ? 0 : 1;
        for (const glm::vec3& n : stream.normals) count += isFinite(n) ? 0 : 1;
      }
    }
  }
  return count;
}

scene::CameraView cameraAt(const glm::dvec3& eye) {
  scene::CameraView camera = outlineCamera({{0, 0, 0}, 1.4}, viewDirection(), kSize);
  camera.worldToView[3] = -(camera.worldToView * glm::dvec4(eye, 0.0));
  camera.worldToView[3].w = 1.0;
  camera.projection.nearPlane = 1e-3f;
  return camera;
}

double eyeInOddPlaces() {
  const scene::Scene scene = coarse();
  const scene::Mesh& mesh = scene.meshes[0];
  double count = 0;
  const glm::dvec3 a(mesh.positions[mesh.indices[0]]), b(mesh.positions[mesh.indices[1]]),
      c(mesh.positions[mesh.indices[2]]);
  for (const glm::dvec3& eye : {a, 0.5 * (a + b), (a + b + c) / 3.0, glm::dvec3(1, 0, 0), glm::dvec3(0.0)}) {
    count += faults(mesh, cameraAt(eye));
    for (const Method method : kMethods) draw(scene, cameraAt(eye), parametersOf(method));
  }
  return count;
}

double oddParameters() {
  const scene::Mesh mesh = coarse().meshes[0];
  const scene::CameraView camera = outlineCamera({{0, 0, 0}, 1.4}, viewDirection(), kSize);
  double count = 0;
  for (const float beta : {0.0f, 1e-38f, 1e-10f, 1e30f}) {
    count += faults(mesh, camera, [&](silhouette::Parameters& p) { p.beta = beta; });
  }
  for (const float tolerance : {0.0f, 1e-30f, 1e30f, std::numeric_limits<float>::infinity()}) {
    count += faults(mesh, camera, [&](silhouette::Parameters& p) { p.tolerance = tolerance; });
  }
  for (const float wedge : {1e-6f, 90.0f, 180.0f}) {
    count += faults(mesh, camera, [&](silhouette::Parameters& p) { p.wedgeDegrees = wedge; });
  }
  return count;
}

double oddNormals() {
  scene::Mesh mesh = coarse().meshes[0];
  const scene::CameraView camera = outlineCamera({{0, 0, 0}, 1.4}, viewDirection(), kSize);
  double count = 0;
  for (glm::vec3& normal : mesh.normals) normal = -normal;
  count += faults(mesh, camera);
  for (std::size_t i = 0; i < mesh.normals.size(); i += 2) mesh.normals[i] = -mesh.normals[i];
  count += faults(mesh, camera);
  for (std::size_t i = 0; i < mesh.normals.size(); i += 3) mesh.normals[i] = glm::vec3(0.0f);
  return count + faults(mesh, camera);
}

double oddWindows() {
  const scene::Scene scene = coarse();
  double count = 0;
  for (const auto& [width, height] : {std::pair{1, 1}, {16384, 1}, {1, 16384}, {16384, 16384}}) {
    scene::CameraView camera = outlineCamera({{0, 0, 0}, 1.4}, viewDirection(), height);
    camera.projection.width = width;
    count += faults(scene.meshes[0], camera);
    if (width * height > 1 << 20) continue;  // the picture itself takes a gigabyte
    for (const Method method : kMethods) {
      const scene::Image image = draw(scene, camera, parametersOf(method));
      if (image.width != width || image.height != height) ++count;
    }
  }
  return count;
}

constexpr const char* kDifferent = "pixels of 36864 that differ from the plain scene's, the worst method's";
constexpr const char* kFaults = "vertices that are not finite and streams that are not consistent";

constexpr std::array kChecks{
    ExtremeCheck{"scene scaled by 2^-20 and 2^20", "pixels", 0, kDifferent, scaledByTwos},
    ExtremeCheck{"scene scaled by 1e-6 and 1e-3", "pixels", 37, kDifferent, scaledDown},
    ExtremeCheck{"scene scaled by 1e3 and 1e6", "pixels", 37, kDifferent, scaledUp},
    ExtremeCheck{"scene moved by 1e6 along each axis", "pixels", 37, kDifferent, movedFar},
    ExtremeCheck{"near : far = 1 : 1e7", "pixels", 0, "pixels that differ from the picture with close planes",
                 farNear},
    ExtremeCheck{"a million degenerate triangles", "pixels", 0, kDifferent, degenerateMillion},
    ExtremeCheck{"degenerate triangles between vertices", "pixels", 0, kDifferent, degenerateBetween},
    ExtremeCheck{"eye on vertex, edge and face, inside", "faults", 0, kFaults, eyeInOddPlaces},
    ExtremeCheck{"beta, tolerance, wedge at their ends", "faults", 0, kFaults, oddParameters},
    ExtremeCheck{"normals opposed, mixed and zero", "faults", 0, kFaults, oddNormals},
    ExtremeCheck{"windows of 1 to 16384 pixels", "faults", 0, kFaults, oddWindows},
};

}  // namespace

std::span<const ExtremeCheck> extremeChecks() {
  return kChecks;
}

}  // namespace limn::measure
