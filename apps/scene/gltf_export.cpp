// Based on: glTF 2.0 Specification, Khronos 2021, section 3.7.2 (meshes).
#include "apps/scene/gltf_export.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "apps/scene/gltf_rewriter.h"

namespace limn::scene {
namespace {

using Json = nlohmann::ordered_json;

enum PrimitiveMode { kLines = 1, kTriangles = 4 };

/// The mesh's values, then those of the stream's vertices.
template <class T>
std::vector<T> joined(std::span<const T> mesh, std::span<const T> stream) {
  std::vector<T> all(mesh.begin(), mesh.end());
  all.insert(all.end(), stream.begin(), stream.end());
  return all;
}

/// glTF wants unit vectors to within rounding.
glm::vec3 unit(const glm::vec3& v) {
  const glm::dvec3 n(v);
  const double length = std::sqrt(glm::dot(n, n));
  return length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f, 0.0f, 1.0f);
}

/// Triangles of one part: those of the mesh that are not replaced, and those of the stream that replace the others.
std::vector<std::uint32_t> partIndices(const RefinedInstance& instance, const raster::Part& part) {
  const silhouette::RefinedStream& stream = *instance.stream;
  const std::uint32_t end = part.firstTriangle + part.triangleCount;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t t = part.firstTriangle; t < end; ++t)
    if (!stream.isReplaced(t))
      indices.insert(indices.end(), &instance.shape.indices[3 * std::size_t{t}],
                     &instance.shape.indices[3 * std::size_t{t}] + 3);
  const auto& sources = stream.sourceTriangles;
  const auto first = std::lower_bound(sources.begin(), sources.end(), part.firstTriangle) - sources.begin();
  const auto last = std::lower_bound(sources.begin(), sources.end(), end) - sources.begin();
  indices.insert(indices.end(), stream.indices.begin() + 3 * first, stream.indices.begin() + 3 * last);
  return indices;
}

/// What meshes must know of the materials of their file.
struct MaterialFacts {
  std::size_t count;
  int highestTexcoordSet;
};

/// One set of texture coordinates serves for all that the materials ask for, as it does when limn draws.
void addTexcoords(const Mesh& mesh, const RefinedInstance& instance, int highestSet, GlbBuilder& builder,
                  Json& attributes) {
  if (mesh.texcoords.empty()) return;
  const int accessor = builder.addVertices(joined<glm::vec2>(mesh.texcoords, instance.texcoords));
  for (int set = 0; set <= highestSet; ++set) attributes["TEXCOORD_" + std::to_string(set)] = accessor;
}

Json addAttributes(const Mesh& mesh, const RefinedInstance& instance, int highestSet, GlbBuilder& builder) {
  const silhouette::RefinedStream& stream = *instance.stream;
  std::vector<glm::vec3> normals = joined<glm::vec3>(instance.shape.normals, stream.normals);
  std::transform(normals.begin(), normals.end(), normals.begin(), unit);
  Json attributes = {
      {"POSITION", builder.addPositions(joined<glm::vec3>(instance.shape.positions, stream.positions))},
      {"NORMAL", builder.addVertices(normals)}};
  if (!instance.meshTangents.empty()) {
    std::vector<glm::vec4> tangents = joined<glm::vec4>(instance.meshTangents, instance.tangents);
    for (glm::vec4& t : tangents) t = glm::vec4(unit(glm::vec3(t)), t.w < 0.0f ? -1.0f : 1.0f);
    attributes["TANGENT"] = builder.addVertices(tangents);
  }
  addTexcoords(mesh, instance, highestSet, builder, attributes);
  if (!mesh.colors.empty()) {  // beyond [0, 1] they are out of the format's range
    std::vector<glm::vec4> colors = joined<glm::vec4>(mesh.colors, instance.colors);
    for (glm::vec4& c : colors) c = glm::clamp(c, 0.0f, 1.0f);
    attributes["COLOR_0"] = builder.addVertices(colors);
  }
  return attributes;
}

Json meshJson(const Mesh& mesh, const RefinedInstance& instance, const MaterialFacts& materials,
              GlbBuilder& builder) {
  const Json attributes = addAttributes(mesh, instance, materials.highestTexcoordSet, builder);
  const std::size_t vertices = instance.shape.positions.size() + instance.stream->positions.size();
  Json primitives = Json::array();
  for (const raster::Part& part : mesh.parts) {
    const std::vector<std::uint32_t> indices = partIndices(instance, part);
    if (indices.empty()) continue;
    Json& primitive = primitives.emplace_back(Json{{"attributes", attributes},
                                                   {"indices", builder.addTriangles(indices, vertices)},
                                                   {"mode", static_cast<int>(kTriangles)}});
    if (part.material < materials.count)
      primitive["material"] = part.material;  // else glTF's default, as in the scene
  }
  return {{"name", mesh.name}, {"primitives", primitives}};
}

/// The edges of the coarse mesh as lines: two vertices each, with the edge's silhouetteness.
Json edgesJson(const Mesh& mesh, const RefinedInstance& instance, const std::vector<float>& alphas,
               GlbBuilder& builder) {
  const silhouette::Topology& topology = *instance.topology;
  std::vector<std::uint32_t> vertexOf(topology.pointCount());
  for (std::size_t v = topology.points().size(); v-- > 0;)
    vertexOf[topology.points()[v]] = static_cast<std::uint32_t>(v);
  std::vector<glm::vec3> positions;
  std::vector<float> values;
  for (std::size_t e = 0; e < topology.edges().size(); ++e)
    for (const std::uint32_t point : topology.edges()[e].point) {
      positions.push_back(instance.shape.positions[vertexOf[point]]);
      values.push_back(alphas[e]);
    }
  return {{"name", mesh.name + " edges"},
          {"primitives",
           {{{"attributes",
              {{"POSITION", builder.addPositions(positions)}, {"_ALPHA", builder.addScalars(values)}}},
             {"mode", static_cast<int>(kLines)}}}}};
}

Json nodeJson(const std::string& name, std::size_t mesh, const glm::dmat4& toWorld) {
  Json matrix = Json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) matrix.push_back(toWorld[column][row]);
  return {{"name", name}, {"mesh", mesh}, {"matrix", matrix}};
}

/// The instances of the frame as meshes and nodes of a GLB that holds their materials.
void addInstances(const Scene& scene, const Pose& pose, FrameDrawer& drawer, const ExportOptions& options,
                  GlbBuilder& builder) {
  Json& root = builder.root;
  root["asset"]["version"] = "2.0";
  root["asset"]["generator"] = options.generator;
  Json nodes = Json::array(), meshes = Json::array();
  const auto place = [&](Json mesh, const glm::dmat4& toWorld) {
    if (mesh["primitives"].empty()) return;
    nodes.push_back(nodeJson(mesh["name"], meshes.size(), toWorld));
    meshes.push_back(std::move(mesh));
  };
  const MaterialFacts materials{scene.materials.size() - 1, highestTexcoordSet(root)};
  std::vector<float> alphas;
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[pose.instances[i].mesh];
    if (mesh.indices.empty() || !pose.instances[i].visible) continue;
    const RefinedInstance instance = drawer.instance(i);
    place(meshJson(mesh, instance, materials, builder), instance.shapeToWorld);
    if (!options.alphas) continue;
    drawer.silhouetteness(i, alphas);
    if (!alphas.empty()) place(edgesJson(mesh, instance, alphas, builder), instance.shapeToWorld);
  }
  root["scene"] = 0;
  root["scenes"] = Json::array({Json::object()});
  if (nodes.empty()) return;
  for (std::size_t i = 0; i < nodes.size(); ++i) root["scenes"][0]["nodes"].push_back(i);
  root["nodes"] = std::move(nodes);
  root["meshes"] = std::move(meshes);
}

}  // namespace

void addBuiltinMaterials(const Scene& scene, Json& root) {
  for (std::size_t i = 0; i + 1 < scene.materials.size(); ++i) {
    const raster::Material& m = scene.materials[i];
    root["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {m.baseColor.r, m.baseColor.g, m.baseColor.b, m.baseColor.a}},
           {"metallicFactor", 0},
           {"roughnessFactor", 0.5}}},
         {"doubleSided", m.doubleSided}});
  }
}

std::vector<std::uint8_t> exportRefined(const Source& source, const Pose& pose, FrameDrawer& drawer,
                                        const ExportOptions& options) {
  if (source.file.bytes.empty()) {
    GlbBuilder builder;
    addBuiltinMaterials(source.scene, builder.root);
    addInstances(source.scene, pose, drawer, options, builder);
    return builder.finish();
  }
  GltfRewriter rewriter(source.file);
  rewriter.keepMaterialsOnly();
  addInstances(source.scene, pose, drawer, options, rewriter.builder());
  return rewriter.builder().finish();
}

}  // namespace limn::scene
