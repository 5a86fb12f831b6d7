#include "apps/scene/builtin.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/scene/load.h"
#include "apps/scene/nearest.h"
#include "apps/scene/shapes.h"
#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

Mesh sphere200() {
  const ProfilePiece profile[] = {arcPiece({0, 0}, 1, -90, 90, 11)};
  return revolve(profile, 10);
}

Mesh cone70() {
  const ProfilePiece profile[] = {straightPiece({0, 0}, {0.6, 0}), straightPiece({0.6, 0}, {0, 1})};
  return revolve(profile, 35);
}

// A chess pawn: rounded foot, concave body, collar, head; creases where body, collar and head meet. `detail`
// times as many chords along the profile as the coarse one has.
Mesh pawn(int sectors, int detail) {
  const ProfilePiece profile[] = {
      straightPiece({0, 0}, {0.58, 0}),
      arcPiece({0.58, 0.13}, 0.13, -90, 90, 3 * detail),
      straightPiece({0.58, 0.26}, {0.48, 0.26}),
      curvePiece({0.48, 0.26}, {0.20, 0.42}, {0.20, 0.98}, 3 * detail),
      straightPiece({0.20, 0.98}, {0.24, 0.98}),
      arcPiece({0.24, 1.06}, 0.08, -90, 90, 2 * detail),
      straightPiece({0.24, 1.14}, {0.192, 1.14}),
      arcPiece({0, 1.396}, 0.32, -53.13010235415598, 90, 4 * detail),
  };
  return revolve(profile, sectors);
}

// A round plate with a soft rim for the others to stand on.
Mesh plate() {
  const ProfilePiece profile[] = {straightPiece({0, -0.16}, {2.9, -0.16}),
                                  arcPiece({2.9, -0.08}, 0.08, -90, 90, 2), straightPiece({2.9, 0}, {0, 0})};
  return revolve(profile, 32);
}

void addMaterial(Scene& scene, const glm::vec3& color, float specular, int shininess) {
  raster::Material material;
  material.baseColor = glm::vec4(color, 1.0f);
  material.specular = glm::vec3(specular);
  material.shininess = shininess;
  scene.materials.push_back(material);
}

void addObject(Scene& scene, std::string name, Mesh mesh, const Node& place, std::uint32_t material) {
  mesh.name = name;
  for (raster::Part& part : mesh.parts) part.material = material;
  Node node = place;
  node.name = std::move(name);
  node.mesh = static_cast<std::int32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(std::move(node));
  scene.inScene.push_back(true);
}

glm::dquat turnAbout(const glm::dvec3& axis, double degrees) {
  const SinCos half = sinCosDegrees(degrees / 2);
  return {half.cos, axis.x * half.sin, axis.y * half.sin, axis.z * half.sin};
}

Node placed(const glm::dvec3& translation, double scale, const glm::dquat& rotation = {1, 0, 0, 0}) {
  Node node;
  node.translation = translation;
  node.rotation = rotation;
  node.scale = glm::dvec3(scale);
  return node;
}

// Coarse things on a plate, each with another kind of silhouette: a closed ball, a body with creases and
// concave parts, a knot that occludes itself, a tip, a ring with a hole.
Scene makeDemo() {
  Scene scene;
  scene.name = "demo";
  addMaterial(scene, {0.32f, 0.34f, 0.38f}, 0.10f, 16);
  addMaterial(scene, {0.80f, 0.62f, 0.36f}, 0.35f, 40);
  addMaterial(scene, {0.10f, 0.38f, 0.60f}, 0.50f, 64);
  addMaterial(scene, {0.72f, 0.13f, 0.10f}, 0.45f, 48);
  addMaterial(scene, {0.20f, 0.52f, 0.24f}, 0.25f, 24);
  addMaterial(scene, {0.78f, 0.74f, 0.68f}, 0.60f, 96);
  addObject(scene, "plate", plate(), placed({0, 0, 0}, 0.82), 0);
  addObject(scene, "pawn", pawn(12, 1), placed({-0.35, 0, 1.2}, 1.05), 1);
  addObject(scene, "knot", knot(30, 6), placed({-0.1, 1.56, -1.05}, 0.44), 2);
  addObject(scene, "sphere", icosphere(1), placed({-1.45, 0.72, 0.15}, 0.74), 3);
  addObject(scene, "cone", cone70(), placed({1.5, 0, -0.1}, 1.3), 4);
  addObject(scene, "ring", torus(12, 8), placed({0.95, 0.22, 1.2}, 0.55, turnAbout({1, 0, 0}, 90)), 5);
  scene.materials.emplace_back();
  return scene;
}

Scene sceneOf(const std::string& name, Mesh mesh) {
  Scene scene;
  scene.name = name;
  scene.materials.emplace_back();
  addObject(scene, name, std::move(mesh), Node{}, 0);
  return scene;
}

// "name:3:4" -> the numbers, if the text has that form with `count` numbers.
std::optional<std::vector<int>> resolutionsOf(std::string_view text, std::string_view shape,
                                              std::size_t count) {
  if (!text.starts_with(shape)) return std::nullopt;
  text.remove_prefix(shape.size());
  std::vector<int> numbers;
  while (!text.empty()) {
    int number = 0;
    if (text.front() != ':') return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return numbers.size() == count ? std::optional(numbers) : std::nullopt;
}

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw InputError("builtin:" + name + ": " + what);
}

void checkTubeResolution(const std::string& name, int along, int around) {
  constexpr int kMaximum = 4096;
  constexpr int kMaximumQuads = 1 << 22;
  const bool legal =
      along >= 3 && around >= 3 && along <= kMaximum && around <= kMaximum && along * around <= kMaximumQuads;
  if (!legal) refuse(name, "M and N are 3 to 4096 each, and at most 4194304 multiplied with each other");
}

std::optional<Mesh> makeWithResolution(const std::string& name) {
  if (const auto n = resolutionsOf(name, "icosphere", 1)) {
    if ((*n)[0] < 0 || (*n)[0] > kMaximumLevel)
      refuse(name, "LEVEL is 0 to " + std::to_string(kMaximumLevel));
    return icosphere((*n)[0]);
  }
  if (const auto n = resolutionsOf(name, "torus", 2)) {
    checkTubeResolution(name, (*n)[0], (*n)[1]);
    return torus((*n)[0], (*n)[1]);
  }
  if (const auto n = resolutionsOf(name, "knot", 2)) {
    checkTubeResolution(name, (*n)[0], (*n)[1]);
    return knot((*n)[0], (*n)[1]);
  }
  if (const auto n = resolutionsOf(name, "pawn", 2)) {
    if ((*n)[0] < 3 || (*n)[0] > 4096 || (*n)[1] < 1 || (*n)[1] > 64)
      refuse(name, "SECTORS is 3 to 4096, DETAIL 1 to 64");
    return pawn((*n)[0], (*n)[1]);
  }
  return std::nullopt;
}

[[noreturn]] void refuseUnknown(const std::string& name) {
  std::vector<std::string> known;
  for (const BuiltinModel& model : builtinModels()) known.push_back(model.name);
  const std::string nearest = nearestName(name, known);
  refuse(name, nearest.empty() ? "no such built-in model; `limn models` lists them"
                               : "no such built-in model; did you mean builtin:" + nearest + "?");
}

}  // namespace

std::vector<BuiltinModel> builtinModels() {
  return {
      {"demo", "six coarse things on a plate, the default model"},
      {"sphere-200", "unit sphere of 10 meridians and 11 bands, 200 triangles"},
      {"icosphere-320", "unit icosphere of level 2, 320 triangles"},
      {"torus-576", "torus:24:12, radii 1 and 0.4 about the z axis, 576 triangles"},
      {"knot-480", "knot:40:6, a tube of radius 0.55 along a trefoil, 480 triangles"},
      {"cone-70",
       "cone of radius 0.6 and height 1 on the plane y = 0, 35 sectors, crease at the rim, 70 triangles"},
      {"pawn", "chess pawn, 12 sectors, creases at collar and head, 360 triangles"},
      {"pawn:SECTORS:DETAIL",
       "the pawn's surface finer: SECTORS 3 to 4096, DETAIL 1 to 64 times the chords of its profile"},
      {"icosphere:LEVEL", "icosahedron divided LEVEL times, 20 * 4^LEVEL triangles, LEVEL 0 to 9"},
      {"torus:M:N", "tube of N sides in M rings along the unit circle, 2 * M * N triangles"},
      {"knot:M:N", "tube of N sides in M rings along a trefoil knot, 2 * M * N triangles"},
  };
}

Scene makeBuiltin(const std::string& name) {
  if (name == "demo") return makeDemo();
  if (name == "sphere-200") return sceneOf(name, sphere200());
  if (name == "icosphere-320") return sceneOf(name, icosphere(2));
  if (name == "torus-576") return sceneOf(name, torus(24, 12));
  if (name == "knot-480") return sceneOf(name, knot(40, 6));
  if (name == "cone-70") return sceneOf(name, cone70());
  if (name == "pawn") return sceneOf(name, pawn(12, 1));
  if (std::optional<Mesh> mesh = makeWithResolution(name)) return sceneOf(name, std::move(*mesh));
  refuseUnknown(name);
}

}  // namespace limn::scene
