// Based on: glTF 2.0 Specification, Khronos 2021, sections 3.7.2 (meshes) and 4.4 (binary layout).
#include "apps/scene/gltf_export.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <span>

namespace limn::scene {
namespace {

using Json = nlohmann::ordered_json;

enum BufferTarget { kVertices = 34962, kIndices = 34963 };
enum PrimitiveMode { kLines = 1, kTriangles = 4 };
constexpr int kFloat = 5126, kUnsignedInt = 5125;

/// Collects the binary chunk, with a view and an accessor for each array.
class Arrays {
 public:
  explicit Arrays(Json& document) : document_(document) {}

  /// `width` floats per element.
  int addFloats(std::span<const float> values, std::size_t width) {
    static constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return add(values.data(), values.size_bytes(), kVertices, kFloat, values.size() / width, kTypes[width]);
  }
  int addPositions(std::span<const float> values) {
    const int index = addFloats(values, 3);
    for (const bool upper : {false, true}) {
      Json bound = Json::array();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float extreme = values[axis];
        for (std::size_t i = axis; i < values.size(); i += 3)
          extreme = upper ? std::max(extreme, values[i]) : std::min(extreme, values[i]);
        bound.push_back(extreme);
      }
      document_["accessors"][static_cast<std::size_t>(index)][upper ? "max" : "min"] = bound;
    }
    return index;
  }
  int addIndices(std::span<const std::uint32_t> values) {
    return add(values.data(), values.size_bytes(), kIndices, kUnsignedInt, values.size(), "SCALAR");
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  int add(const void* data, std::size_t size, BufferTarget target, int componentType, std::size_t count,
          const char* type) {
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + size);  // every size is a multiple of four
    std::memcpy(bytes_.data() + offset, data, size);
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}, {"target", static_cast<int>(target)}});
    document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                      {"componentType", componentType},
                                      {"count", count},
                                      {"type", type}});
    return static_cast<int>(document_["accessors"].size()) - 1;
  }

  Json& document_;
  std::vector<std::uint8_t> bytes_;
};

/// The mesh's values, then those of the stream's vertices.
template <class T>
std::vector<float> joined(std::span<const T> mesh, std::span<const T> stream) {
  constexpr std::size_t kWidth = sizeof(T) / sizeof(float);
  std::vector<float> all;
  all.reserve(kWidth * (mesh.size() + stream.size()));
  for (const std::span<const T> part : {mesh, stream})
    for (const T& value : part)
      for (std::size_t c = 0; c < kWidth; ++c) all.push_back(value[static_cast<int>(c)]);
  return all;
}

/// glTF wants unit normals to within rounding.
void normalize(std::vector<float>& normals) {
  for (std::size_t i = 0; i + 2 < normals.size(); i += 3) {
    const glm::dvec3 n(normals[i], normals[i + 1], normals[i + 2]);
    const double length = std::sqrt(glm::dot(n, n));
    const glm::dvec3 unit = length > 0.0 ? n / length : glm::dvec3(0.0, 0.0, 1.0);
    for (std::size_t c = 0; c < 3; ++c) normals[i + c] = static_cast<float>(unit[static_cast<int>(c)]);
  }
}

/// Colours beyond [0, 1] are out of the format's range.
void clampColors(std::vector<float>& colors) {
  for (float& c : colors) c = std::clamp(c, 0.0f, 1.0f);
}

Json materialJson(const raster::Material& m, bool& usesUnlit) {
  constexpr const char* kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
  Json json = {{"pbrMetallicRoughness",
                {{"baseColorFactor", {m.baseColor.r, m.baseColor.g, m.baseColor.b, m.baseColor.a}},
                 {"metallicFactor", 0},
                 {"roughnessFactor", 0.5}}},
               {"alphaMode", kAlphaModes[static_cast<int>(m.alphaMode)]},
               {"doubleSided", m.doubleSided}};
  if (m.alphaMode == raster::AlphaMode::kMask) json["alphaCutoff"] = m.alphaCutoff;
  if (m.unlit) {
    json["extensions"] = {{"KHR_materials_unlit", Json::object()}};
    usesUnlit = true;
  }
  return json;
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

Json meshJson(const Mesh& mesh, const RefinedInstance& instance, Arrays& arrays) {
  const silhouette::RefinedStream& stream = *instance.stream;
  const std::vector<float> positions = joined<glm::vec3>(instance.shape.positions, stream.positions);
  std::vector<float> normals = joined<glm::vec3>(instance.shape.normals, stream.normals);
  normalize(normals);
  Json attributes = {{"POSITION", arrays.addPositions(positions)}, {"NORMAL", arrays.addFloats(normals, 3)}};
  if (!mesh.texcoords.empty())
    attributes["TEXCOORD_0"] = arrays.addFloats(joined<glm::vec2>(mesh.texcoords, instance.texcoords), 2);
  if (!mesh.colors.empty()) {
    std::vector<float> colors = joined<glm::vec4>(mesh.colors, instance.colors);
    clampColors(colors);
    attributes["COLOR_0"] = arrays.addFloats(colors, 4);
  }
  Json primitives = Json::array();
  for (const raster::Part& part : mesh.parts) {
    const std::vector<std::uint32_t> indices = partIndices(instance, part);
    if (indices.empty()) continue;
    primitives.push_back({{"attributes", attributes},
                          {"indices", arrays.addIndices(indices)},
                          {"material", part.material},
                          {"mode", static_cast<int>(kTriangles)}});
  }
  return {{"name", mesh.name}, {"primitives", primitives}};
}

/// The edges of the coarse mesh as lines: two vertices each, with the edge's silhouetteness.
Json edgesJson(const Mesh& mesh, const RefinedInstance& instance, const std::vector<float>& alphas,
               Arrays& arrays) {
  const silhouette::Topology& topology = *instance.topology;
  std::vector<std::uint32_t> vertexOf(topology.pointCount());
  for (std::size_t v = topology.points().size(); v-- > 0;)
    vertexOf[topology.points()[v]] = static_cast<std::uint32_t>(v);
  std::vector<float> positions, values;
  for (std::size_t e = 0; e < topology.edges().size(); ++e)
    for (const std::uint32_t point : topology.edges()[e].point) {
      const glm::vec3& p = instance.shape.positions[vertexOf[point]];
      positions.insert(positions.end(), {p.x, p.y, p.z});
      values.push_back(alphas[e]);
    }
  return {{"name", mesh.name + " edges"},
          {"primitives",
           {{{"attributes",
              {{"POSITION", arrays.addPositions(positions)}, {"_ALPHA", arrays.addFloats(values, 1)}}},
             {"mode", static_cast<int>(kLines)}}}}};
}

Json nodeJson(const std::string& name, std::size_t mesh, const glm::dmat4& toWorld) {
  Json matrix = Json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) matrix.push_back(toWorld[column][row]);
  return {{"name", name}, {"mesh", mesh}, {"matrix", matrix}};
}

void append32(std::vector<std::uint8_t>& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Header, JSON chunk, BIN chunk; both chunks end on a multiple of four.
std::vector<std::uint8_t> container(std::string json, const std::vector<std::uint8_t>& bytes) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::vector<std::uint8_t> out;
  append32(out, 0x46546c67);  // "glTF"
  append32(out, 2);
  append32(out, 12 + 8 + json.size() + (bytes.empty() ? 0 : 8 + bytes.size()));
  append32(out, json.size());
  append32(out, 0x4e4f534a);  // "JSON"
  out.insert(out.end(), json.begin(), json.end());
  if (bytes.empty()) return out;
  append32(out, bytes.size());
  append32(out, 0x004e4942);  // "BIN"
  out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

}  // namespace

std::vector<std::uint8_t> exportRefined(const Scene& scene, const Pose& pose, FrameDrawer& drawer,
                                        const ExportOptions& options) {
  Json document = {{"asset", {{"version", "2.0"}, {"generator", options.generator}}}, {"scene", 0}};
  Json roots = Json::array();
  Arrays arrays(document);
  std::vector<float> alphas;
  const auto place = [&](Json mesh, const glm::dmat4& toWorld) {
    if (mesh["primitives"].empty()) return;
    document["nodes"].push_back(nodeJson(mesh["name"], document["meshes"].size(), toWorld));
    roots.push_back(document["nodes"].size() - 1);
    document["meshes"].push_back(std::move(mesh));
  };
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[pose.instances[i].mesh];
    if (mesh.indices.empty() || !pose.instances[i].visible) continue;
    const RefinedInstance instance = drawer.instance(i);
    place(meshJson(mesh, instance, arrays), instance.shapeToWorld);
    if (!options.alphas) continue;
    drawer.silhouetteness(i, alphas);
    if (!alphas.empty()) place(edgesJson(mesh, instance, alphas, arrays), instance.shapeToWorld);
  }
  document["scenes"] = {{{"nodes", roots}}};
  if (roots.empty()) document["scenes"] = Json::array({Json::object()});
  bool usesUnlit = false;
  for (const raster::Material& material : scene.materials)
    document["materials"].push_back(materialJson(material, usesUnlit));
  if (usesUnlit) document["extensionsUsed"] = {"KHR_materials_unlit"};
  if (!arrays.bytes().empty()) document["buffers"] = {{{"byteLength", arrays.bytes().size()}}};
  return container(document.dump(-1, ' ', false, Json::error_handler_t::replace), arrays.bytes());
}

}  // namespace limn::scene
