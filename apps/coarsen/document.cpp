// The JSON is edited as it is, so that what limn does not know survives; only references to accessors and buffer views
// are numbered anew, where glTF 2.0 says they are.
#include "apps/coarsen/document.h"

#include <algorithm>
#include <iostream>
#include <iterator>

#include "apps/scene/builtin.h"
#include "apps/scene/glb_builder.h"
#include "apps/scene/gltf_container.h"
#include "apps/scene/gltf_fitted.h"
#include "apps/scene/gltf_load.h"
#include "apps/scene/gltf_uri.h"
#include "apps/scene/load.h"

namespace limn::coarsen {
namespace {

using Json = nlohmann::ordered_json;
using scene::GlbBuilder;

/// The source's JSON on its way into a GLB.
class Rewriter {
 public:
  explicit Rewriter(const Source& source) : document_(source.name, source.bytes, source.folder) {
    std::vector<std::string> notices;
    json_ = Json::parse(scene::splitContainer(source.name, source.bytes, notices).json);
    oldAccessors_ = json_.value("accessors", Json::array());
    oldViews_ = json_.value("bufferViews", Json::array());
    for (const char* name : {"accessors", "bufferViews", "buffers"}) json_.erase(name);
    newAccessor_.assign(oldAccessors_.size(), -1);
    newView_.assign(oldViews_.size(), -1);
    builder_.root = std::move(json_);
  }

  GlbBuilder& builder() { return builder_; }
  Json& root() { return builder_.root; }

  /// Brings over what `json[name]` refers to and changes the reference.
  void keepAccessor(Json& json, const char* name) {
    if (json.contains(name)) json[name] = accessor(json[name].get<std::size_t>());
  }
  void keepView(Json& json, const char* name) {
    if (json.contains(name)) json[name] = view(json[name].get<std::size_t>());
  }

  /// Everything but the meshes.
  void keepRest() {
    for (Json& skin : listOf(root(), "skins")) keepAccessor(skin, "inverseBindMatrices");
    for (Json& animation : listOf(root(), "animations"))
      for (Json& sampler : listOf(animation, "samplers")) {
        keepAccessor(sampler, "input");
        keepAccessor(sampler, "output");
      }
    std::size_t index = 0;
    for (Json& image : listOf(root(), "images")) keepImage(image, index++);
  }
  void keepMesh(std::size_t index) {
    const auto keepAttributes = [&](Json& attributes) {
      for (auto& attribute : attributes.items())
        attribute.value() = accessor(attribute.value().get<std::size_t>());
    };
    for (Json& primitive : listOf(root()["meshes"][index], "primitives")) {
      keepAccessor(primitive, "indices");
      keepAttributes(primitive["attributes"]);
      for (Json& target : listOf(primitive, "targets")) keepAttributes(target);
    }
  }

  static Json& listOf(Json& json, const char* name) {
    static Json none = Json::array();
    const auto found = json.find(name);
    return found != json.end() && found->is_array() ? *found : none;
  }

 private:
  int accessor(std::size_t old) {
    if (newAccessor_.at(old) >= 0) return newAccessor_[old];
    Json json = oldAccessors_[old];
    keepView(json, "bufferView");
    if (json.contains("sparse"))
      for (const char* part : {"indices", "values"}) keepView(json["sparse"][part], "bufferView");
    root()["accessors"].push_back(std::move(json));
    return newAccessor_[old] = static_cast<int>(root()["accessors"].size()) - 1;
  }

  int view(std::size_t old) {
    if (newView_.at(old) >= 0) return newView_[old];
    Json json = oldViews_[old];
    const std::size_t offset = json.value("byteOffset", std::size_t{0}),
                      length = json["byteLength"].get<std::size_t>();
    const scene::GltfBuffer& buffer = document_.buffers.at(json["buffer"].get<std::size_t>());
    std::span<const std::uint8_t> bytes;
    if (buffer.bytes && offset <= buffer.bytes->size() && length <= buffer.bytes->size() - offset)
      bytes = buffer.bytes->subspan(offset, length);
    const int index = builder_.addView(bytes, GlbBuilder::kNoTarget);
    Json& added = root()["bufferViews"].back();
    for (auto& item : json.items())
      if (!added.contains(item.key())) added[item.key()] = item.value();
    return newView_[old] = index;
  }

  void keepImage(Json& image, std::size_t index) {
    keepView(image, "bufferView");
    const scene::GltfImage& external = document_.images.at(index);
    if (external.uri.empty()) return;
    std::string problem;
    const std::filesystem::path path = scene::resolveUri(external.uri, external.folder, problem);
    if (!problem.empty()) return;  // as missing in the copy as it was
    constexpr std::size_t kLargest = std::size_t{1} << 31;
    const std::optional<std::vector<std::uint8_t>> bytes = scene::readFileBytes(path, kLargest);
    if (!bytes) return;  // as missing in the copy as it was
    image.erase("uri");
    image["bufferView"] = builder_.addView(*bytes, GlbBuilder::kNoTarget);
    if (!image.contains("mimeType"))
      image["mimeType"] =
          bytes->size() > 1 && (*bytes)[0] == 0xff && (*bytes)[1] == 0xd8 ? "image/jpeg" : "image/png";
  }

  scene::GltfDocument document_;
  Json json_, oldAccessors_, oldViews_;
  std::vector<int> newAccessor_, newView_;
  GlbBuilder builder_;
};

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
  for (std::size_t m = 0; m + 1 < scene.materials.size(); ++m) {
    const raster::Material& material = scene.materials[m];
    root["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor",
            {material.baseColor.r, material.baseColor.g, material.baseColor.b, material.baseColor.a}},
           {"metallicFactor", 0.0}}}});
  }
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

/// The highest set of texture coordinates that a material asks for.
int highestSet(const Json& json) {
  int highest = json.is_object() && json.contains("texCoord") ? json["texCoord"].get<int>() : 0;
  if (json.is_structured())
    for (const auto& item : json.items()) highest = std::max(highest, highestSet(item.value()));
  return highest;
}

/// One primitive per part, all with the same vertices. Where materials want a further set of texture coordinates, the
/// one set that limn has read is that one too.
void addMesh(GlbBuilder& builder, const scene::Mesh& mesh, std::size_t materials, Json& json) {
  const std::vector<glm::vec3> positions = filePositions(mesh);
  Json attributes = addAttributes(builder, mesh, positions);
  if (!mesh.texcoords.empty())
    for (int set = highestSet(builder.root.value("materials", Json::array())); set > 0; --set)
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

Source openSource(const std::string& model) {
  Source source;
  source.name = model;
  const std::string prefix = "builtin:";
  if (model.starts_with(prefix)) {
    source.scene = scene::makeBuiltin(model.substr(prefix.size()));
    return source;
  }
  if (model == "-") {
    source.name = "standard input";
    source.bytes.assign(std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>());
  } else {
    constexpr std::size_t kLargestFile = std::size_t{1} << 40;
    const std::filesystem::path path(model);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
      return {model, {}, {}, scene::load(model)};  // says what is wrong
    std::optional<std::vector<std::uint8_t>> bytes = scene::readFileBytes(path, kLargestFile);
    if (!bytes) throw scene::InputError(model + ": cannot be read; may you read it?");
    source.bytes = std::move(*bytes);
    source.folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  }
  source.scene = scene::loadGltf(source.name, source.bytes, source.folder, {});
  return source;
}

std::vector<std::uint8_t> withMeshes(const Source& source, const std::vector<scene::Mesh>& meshes) {
  const std::size_t materials = source.scene.materials.size() - 1;
  if (source.bytes.empty()) {
    GlbBuilder builder;
    builder.root = builtinRoot(source.scene);
    for (std::size_t m = 0; m < meshes.size(); ++m)
      addMesh(builder, meshes[m], materials, builder.root["meshes"][m]);
    declareExtension(builder.root);
    return builder.finish();
  }
  Rewriter rewriter(source);
  rewriter.keepRest();
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].indices.empty())
      rewriter.keepMesh(m);  // points and lines
    else
      addMesh(rewriter.builder(), meshes[m], materials, rewriter.root()["meshes"][m]);
  }
  declareExtension(rewriter.root());
  return rewriter.builder().finish();
}

std::vector<std::uint8_t> withCurves(const Source& source, const std::vector<scene::Mesh>& meshes) {
  if (source.bytes.empty()) return withMeshes(source, meshes);
  Rewriter rewriter(source);
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
