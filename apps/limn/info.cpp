// limn info: what a model holds and what limn makes of it.
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/limn/commands.h"
#include "apps/limn/job.h"
#include "apps/limn/values.h"
#include "apps/scene/gltf_json.h"
#include "apps/scene/load.h"
#include "apps/scene/pose.h"
#include "silhouette/topology.h"

namespace limn::program {
namespace {

using Json = nlohmann::ordered_json;

Json topologyJson(const scene::Mesh& mesh) {
  const silhouette::Topology topology(silhouette::Mesh{mesh.positions, mesh.normals, mesh.indices});
  const silhouette::TopologyReport& report = topology.report();
  return {{"points", topology.pointCount()},
          {"edges", topology.edges().size()},
          {"boundary_edges", report.boundaryEdges},
          {"non_manifold_edges", report.nonManifoldEdges},
          {"feature_edges", report.featureEdges},
          {"degenerate_triangles", report.degenerateTriangles},
          {"opposed_triangles", report.opposedTriangles},
          {"closed", report.boundaryEdges + report.nonManifoldEdges == 0}};
}

/// Null where the mesh has none.
Json curvesJson(const scene::Mesh& mesh) {
  if (mesh.curves.empty()) return nullptr;
  const std::size_t bytes =
      sizeof(scene::StoredVector) * (mesh.curves.ends.size() + mesh.curves.centers.size());
  return {
      {"edges", mesh.curves.ends.size() / 2},
      {"bytes", bytes},
      {"bytes_per_triangle", static_cast<double>(bytes) / static_cast<double>(mesh.curves.centers.size())}};
}

Json meshJson(const scene::Mesh& mesh) {
  Json attributes = Json::array({"positions", "normals"});
  if (!mesh.texcoords.empty()) attributes.push_back("texcoords");
  if (!mesh.colors.empty()) attributes.push_back("colors");
  if (!mesh.tangents.empty()) attributes.push_back("tangents");
  return {{"name", mesh.name},
          {"triangles", mesh.indices.size() / 3},
          {"vertices", mesh.positions.size()},
          {"parts", mesh.parts.size()},
          {"attributes", attributes},
          {"morph_targets", mesh.targets.size()},
          {"skinned", !mesh.skinning.empty()},
          {"fitted_curves", curvesJson(mesh)},
          {"topology", topologyJson(mesh)}};
}

Json materialJson(const raster::Material& m) {
  constexpr const char* kAlphaModes[] = {"opaque", "mask", "blend"};
  const auto color = [](const glm::vec4& c) { return Json::array({c.r, c.g, c.b, c.a}); };
  Json textures = Json::array();
  if (m.baseColorTexture != nullptr) textures.push_back("base colour");
  if (m.normalTexture != nullptr) textures.push_back("normal");
  if (m.emissiveTexture != nullptr) textures.push_back("emissive");
  return {{"base_color", color(m.baseColor)},
          {"alpha", kAlphaModes[static_cast<int>(m.alphaMode)]},
          {"double_sided", m.doubleSided},
          {"unlit", m.unlit},
          {"textures", textures}};
}

Json animationsJson(const scene::Scene& scene) {
  Json all = Json::array();
  for (const scene::Animation& a : scene.animations)
    all.push_back({{"name", a.name}, {"seconds", a.duration}, {"channels", a.channels.size()}});
  return all;
}

Json camerasJson(const scene::Scene& scene) {
  Json all = Json::array();
  for (const scene::Camera& c : scene.cameras)
    all.push_back({{"name", c.name}, {"kind", c.perspective ? "perspective" : "orthographic"}});
  return all;
}

Json boundsJson(const scene::Scene& scene) {
  scene::Pose pose;
  scene::evaluatePose(scene, -1, 0.0, pose);
  const scene::Sphere sphere = scene::boundingSphere(scene, pose);
  return {{"center", {sphere.center.x, sphere.center.y, sphere.center.z}}, {"radius", sphere.radius}};
}

std::size_t countInstances(const scene::Scene& scene) {
  std::size_t instances = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.inScene[i] && scene.nodes[i].mesh >= 0) ++instances;
  return instances;
}

Json sceneJson(const std::string& model, const scene::Scene& scene) {
  Json json = {{"model", model},
               {"scene", scene.name},
               {"nodes", scene.nodes.size()},
               {"instances", countInstances(scene)},
               {"triangles_drawn", drawnTriangles(scene)},
               {"bounds", boundsJson(scene)}};
  json["meshes"] = Json::array();
  for (const scene::Mesh& mesh : scene.meshes) json["meshes"].push_back(meshJson(mesh));
  json["materials"] = Json::array();
  for (const raster::Material& material : scene.materials)
    json["materials"].push_back(materialJson(material));
  json["textures"] = scene.textures.size();
  json["skins"] = scene.skins.size();
  json["lights"] = scene.lights.size();
  json["cameras"] = camerasJson(scene);
  json["animations"] = animationsJson(scene);
  json["notices"] = scene.notices;
  return json;
}

std::string counted(const Json& count, const std::string& one, const std::string& many) {
  const auto n = count.get<std::size_t>();
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string nameOf(const Json& item, std::size_t index) {
  const auto name = item["name"].get<std::string>();
  return name.empty() ? std::to_string(index) : std::to_string(index) + " " + scene::inQuotes(name);
}

void printMesh(const Json& mesh, std::size_t index) {
  const Json& t = mesh["topology"];
  std::cout << "  mesh " << nameOf(mesh, index) << ": " << counted(mesh["triangles"], "triangle", "triangles")
            << ", " << counted(mesh["vertices"], "vertex", "vertices");
  for (const Json& attribute : mesh["attributes"])
    if (attribute != "positions" && attribute != "normals") std::cout << ", " << attribute.get<std::string>();
  if (mesh["skinned"].get<bool>()) std::cout << ", skinned";
  if (mesh["morph_targets"] != 0)
    std::cout << ", " << counted(mesh["morph_targets"], "morph target", "morph targets");
  std::cout << "\n    " << (t["closed"].get<bool>() ? "closed" : "open") << ": "
            << counted(t["points"], "point", "points") << ", " << counted(t["edges"], "edge", "edges")
            << ", of them " << t["boundary_edges"] << " boundary, " << t["non_manifold_edges"]
            << " non-manifold, " << t["feature_edges"] << " features\n";
  if (const Json& curves = mesh["fitted_curves"]; !curves.is_null())
    std::cout << "    fitted curves: " << counted(curves["edges"], "edge", "edges") << ", "
              << counted(curves["bytes"], "byte", "bytes") << ", " << curves["bytes_per_triangle"]
              << " per triangle\n";
  if (t["degenerate_triangles"] != 0)
    std::cout << "    " << counted(t["degenerate_triangles"], "triangle", "triangles") << " without area\n";
  if (t["opposed_triangles"] != 0)
    std::cout << "    " << counted(t["opposed_triangles"], "triangle faces", "triangles face")
              << " against the vertex normals; they stay flat where curves would fold\n";
}

void printReadable(const Json& json) {
  const Json& bounds = json["bounds"];
  std::cout << json["model"].get<std::string>() << ": "
            << counted(json["triangles_drawn"], "triangle", "triangles") << " drawn in "
            << counted(json["instances"], "instance", "instances") << '\n';
  std::cout << "  bounds: centre " << bounds["center"][0] << ", " << bounds["center"][1] << ", "
            << bounds["center"][2] << ", radius " << bounds["radius"] << '\n';
  std::size_t index = 0;
  for (const Json& mesh : json["meshes"]) printMesh(mesh, index++);
  std::size_t textured = 0, blended = 0, doubleSided = 0;
  for (const Json& m : json["materials"]) {
    textured += m["textures"].empty() ? 0 : 1;
    blended += m["alpha"] == "opaque" ? 0 : 1;
    doubleSided += m["double_sided"].get<bool>() ? 1 : 0;
  }
  std::cout << "  " << counted(json["materials"].size(), "material", "materials") << ": " << textured
            << " textured, " << blended << " with alpha, " << doubleSided << " double-sided; "
            << counted(json["textures"], "texture", "textures") << '\n';
  index = 0;
  for (const Json& animation : json["animations"])
    std::cout << "  animation " << nameOf(animation, index++) << ": " << animation["seconds"] << " s, "
              << counted(animation["channels"], "channel", "channels") << '\n';
  index = 0;
  for (const Json& camera : json["cameras"])
    std::cout << "  camera " << nameOf(camera, index++) << ": " << camera["kind"].get<std::string>() << '\n';
  if (json["lights"] != 0) std::cout << "  " << counted(json["lights"], "light", "lights") << '\n';
  for (const Json& notice : json["notices"]) std::cout << "  note: " << notice.get<std::string>() << '\n';
  std::cout << std::flush;
}

}  // namespace

int info(const InfoOptions& options) {
  const Json json = sceneJson(options.model, scene::load(options.model));
  if (options.json)
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
  else
    printReadable(json);
  return kDone;
}

}  // namespace limn::program
