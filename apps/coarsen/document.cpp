#include "apps/coarsen/document.h"

#include <algorithm>
#include <span>

#include "apps/scene/gltf_export.h"
#include "apps/scene/gltf_fitted.h"
#include "apps/scene/gltf_rewriter.h"

namespace limn::coarsen {
namespace {

using Json = nlohmann::ordered_json;
using scene::GlbBuilder;
using scene::GltfRewriter;
using scene::Source;

Json builtinRoot(const scene::Scene& scene) {
  Json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const scene::Node& node = scene.nodes[i];
    Json json = {{"name", node.name}};
    if (node.mesh >= 0) json["mesh"] = node.mesh;
    json["translation"] = {node.translation.x, node.translation.y, node.translation.z};
    json["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
    json["scale"] = {node.scale.x, node.scale.y, node.scale.z};
    root["nodes"].push_back(std::move(json));
    if (node.parent < 0)
      root["scenes"][0]["nodes"].push_back(i);
    else
      root["nodes"][static_cast<std::size_t>(node.parent)]["children"].push_back(i);
  }
  scene::addBuiltinMaterials(scene, root);
  for (const scene::Mesh& mesh : scene.meshes) root["meshes"].push_back({{"name", mesh.name}});
  return root;
}

void declareExtension(Json& root) {
  Json& used = root["extensionsUsed"];
  if (used.is_null()) used = Json::array();
  if (std::find(used.begin(), used.end(), scene::kFittedCurvesName) == used.end())
    used.push_back(scene::kFittedCurvesName);
}

std::vector<glm::vec3> filePositions(const scene::Mesh& mesh) {
  if (mesh.origin == glm::dvec3(0.0) && mesh.scale == 1.0) return mesh.positions;
  std::vector<glm::vec3> positions;
  positions.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) positions.emplace_back(mesh.origin + mesh.scale * glm::dvec3(p));
  return positions;
}

std::vector<glm::vec3> cornersOf(const std::vector<glm::vec3>& positions,
                                 const std::vector<std::uint32_t>& indices) {
  std::vector<glm::vec3> corners;
  corners.reserve(indices.size());
  for (const std::uint32_t index : indices) corners.push_back(positions[index]);
  return corners;
}

Json addAttributes(GlbBuilder& builder, const scene::Mesh& mesh, const std::vector<glm::vec3>& positions) {
  Json attributes = {{"POSITION", builder.addPositions(positions)},
                     {"NORMAL", builder.addVertices(mesh.normals)}};
  if (!mesh.tangents.empty()) attributes["TANGENT"] = builder.addVertices(mesh.tangents);
  if (!mesh.texcoords.empty()) attributes["TEXCOORD_0"] = builder.addVertices(mesh.texcoords);
  if (!mesh.colors.empty()) attributes["COLOR_0"] = builder.addVertices(mesh.colors);
  for (std::size_t set = 0; set < mesh.skinning.size(); ++set) {
    const scene::SkinBinding& binding = mesh.skinning[set];
    std::vector<std::uint8_t> bytes;
    for (const auto& joints : binding.joints)
      for (const std::uint16_t joint : joints) {
        bytes.push_back(static_cast<std::uint8_t>(joint));
        bytes.push_back(static_cast<std::uint8_t>(joint >> 8));
      }
    attributes["JOINTS_" + std::to_string(set)] =
        builder.addAccessor(builder.addView(bytes, GlbBuilder::kVertices), GlbBuilder::kUnsignedShort, "VEC4",
                            binding.joints.size());
    attributes["WEIGHTS_" + std::to_string(set)] = builder.addVertices(binding.weights);
  }
  return attributes;
}

Json addTargets(GlbBuilder& builder, const scene::Mesh& mesh) {
  Json targets = Json::array();
  for (const scene::MorphTarget& target : mesh.targets) {
    Json json = Json::object();
    if (!target.positions.empty()) {
      std::vector<glm::vec3> offsets;
      for (const glm::vec3& p : target.positions) offsets.emplace_back(mesh.scale * glm::dvec3(p));
      json["POSITION"] = builder.addPositions(offsets);
    }
    if (!target.normals.empty()) json["NORMAL"] = builder.addVertices(target.normals);
    if (!target.tangents.empty()) json["TANGENT"] = builder.addVertices(target.tangents);
    targets.push_back(std::move(json));
  }
  return targets;
}

/// One primitive per part, all with the same vertices. Where materials want a further set of texture coordinates, the
/// one set that limn has read is that one too.
void addMesh(GlbBuilder& builder, const scene::Mesh& mesh, std::size_t materials, int highestSet,
             Json& json) {
  const std::vector<glm::vec3> positions = filePositions(mesh);
  Json attributes = addAttributes(builder, mesh, positions);
  if (!mesh.texcoords.empty())
    for (int set = highestSet; set > 0; --set)
      attributes["TEXCOORD_" + std::to_string(set)] = attributes["TEXCOORD_0"];
  const Json targets = addTargets(builder, mesh);
  json["primitives"] = Json::array();
  for (const raster::Part& part : mesh.parts) {
    const std::span<const std::uint32_t> indices =
        std::span(mesh.indices)
            .subspan(3 * std::size_t{part.firstTriangle}, 3 * std::size_t{part.triangleCount});
    Json primitive = {{"attributes", attributes},
                      {"indices", builder.addTriangles(indices, positions.size())}};
    if (part.material < materials) primitive["material"] = part.material;
    if (!targets.empty()) primitive["targets"] = targets;
    json["primitives"].push_back(std::move(primitive));
  }
  if (!mesh.curves.empty())
    json["extensions"][scene::kFittedCurvesName] =
        scene::writeFittedCurves(builder, mesh.curves, cornersOf(positions, mesh.indices));
}

}  // namespace

std::vector<std::uint8_t> withMeshes(const Source& source, const std::vector<scene::Mesh>& meshes) {
  const std::size_t materials = source.scene.materials.size() - 1;
  if (source.file.bytes.empty()) {
    GlbBuilder builder;
    builder.root = builtinRoot(source.scene);
    for (std::size_t m = 0; m < meshes.size(); ++m)
      addMesh(builder, meshes[m], materials, 0, builder.root["meshes"][m]);
    declareExtension(builder.root);
    return builder.finish();
  }
  GltfRewriter rewriter(source.file);
  rewriter.keepRest();
  const int highestSet = scene::highestTexcoordSet(rewriter.root());
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].indices.empty())
      rewriter.keepMesh(m);  // points and lines
    else
      addMesh(rewriter.builder(), meshes[m], materials, highestSet, rewriter.root()["meshes"][m]);
  }
  declareExtension(rewriter.root());
  return rewriter.builder().finish();
}

std::vector<std::uint8_t> withCurves(const Source& source, const std::vector<scene::Mesh>& meshes) {
  if (source.file.bytes.empty()) return withMeshes(source, meshes);
  GltfRewriter rewriter(source.file);
  rewriter.keepRest();
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    rewriter.keepMesh(m);
    if (!meshes[m].curves.empty())
      rewriter.root()["meshes"][m]["extensions"][scene::kFittedCurvesName] = scene::writeFittedCurves(
          rewriter.builder(), meshes[m].curves, cornersOf(filePositions(meshes[m]), meshes[m].indices));
  }
  declareExtension(rewriter.root());
  return rewriter.builder().finish();
}

}  // namespace limn::coarsen
