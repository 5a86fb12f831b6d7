// Based on: glTF 2.0 specification, section 3.7.2 "Meshes", and KHR_mesh_quantization.
// Differs in: attributes may have any component type; weights need not be normalized.
#include "apps/scene/gltf_primitive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "apps/scene/gltf_accessor.h"

namespace limn::scene {
namespace {

using Attributes = std::map<std::string, int>;
using Elements = std::vector<std::uint32_t>;

class PrimitiveReader {
 public:
  PrimitiveReader(GltfDocument& document, std::size_t mesh, std::size_t primitive, PrimitiveReport& report)
      : document_(document),
        source_(document.model.meshes[mesh].primitives[primitive]),
        place_(jsonPointer("meshes", mesh, "primitives", primitive)),
        report_(report) {}

  PrimitiveArrays read(int texcoordSet) {
    PrimitiveArrays arrays;
    if (source_.mode < TINYGLTF_MODE_TRIANGLES) {
      ++report_.pointsAndLines;
      return arrays;
    }
    const auto position = source_.attributes.find("POSITION");
    if (position == source_.attributes.end()) {
      ++report_.withoutPositions;
      return arrays;
    }
    vertexCount_ = checkedReader(position->second, attributePlace("POSITION"), TINYGLTF_TYPE_VEC3).count();
    arrays.indices = readTriangles();
    const Elements used = compact(arrays.indices);
    elements_ = used.size() == vertexCount_ ? nullptr : &used;
    if (used.empty()) return arrays;
    readVertices(arrays, texcoordSet);
    readSkinning(arrays);
    readTargets(arrays);
    return arrays;
  }

 private:
  std::string attributePlace(const std::string& name) const { return place_ + "/attributes/" + name; }

  /// A reader for accessor `accessor`, which must be of `type` (or, where given, `otherType`).
  AccessorReader checkedReader(int accessor, const std::string& place, int type, int otherType = 0) const {
    const int actual = document_.model.accessors[static_cast<std::size_t>(accessor)].type;
    if (actual != type && actual != otherType) {
      document_.refuse(
          place, "accessor " + std::to_string(accessor) + " has " +
                     std::to_string(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(actual))) +
                     " components per element; " +
                     std::to_string(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type))) +
                     " belong here");
    }
    return {document_, accessor};
  }

  /// The same for a vertex attribute, which must have as many elements as there are positions.
  AccessorReader vertexReader(int accessor, const std::string& place, int type, int otherType = 0) const {
    AccessorReader reader = checkedReader(accessor, place, type, otherType);
    if (reader.count() != vertexCount_) {
      document_.refuse(place, "accessor " + std::to_string(accessor) + " has " +
                                  std::to_string(reader.count()) + " elements, the positions have " +
                                  std::to_string(vertexCount_));
    }
    return reader;
  }

  template <class Vector>
  std::vector<Vector> readAttribute(const std::string& name, int type) const {
    const auto found = source_.attributes.find(name);
    if (found == source_.attributes.end()) return {};
    return gather<Vector>(document_, vertexReader(found->second, attributePlace(name), type), elements_);
  }

  std::vector<std::uint32_t> readTriangles() {
    std::vector<std::uint32_t> corners;
    const std::string place = place_ + "/indices";
    if (source_.indices < 0) {
      document_.charge(vertexCount_ * sizeof(std::uint32_t) * 3, attributePlace("POSITION"));
      corners.resize(vertexCount_);
      for (std::size_t i = 0; i < vertexCount_; ++i) corners[i] = static_cast<std::uint32_t>(i);
    } else {
      corners = readIndices(checkedReader(source_.indices, place, TINYGLTF_TYPE_SCALAR), place);
    }
    if (source_.mode == TINYGLTF_MODE_TRIANGLES ? corners.size() % 3 != 0 : corners.size() < 3)
      ++report_.cutShort;
    return triangulate(std::move(corners), source_.mode);
  }

  std::vector<std::uint32_t> readIndices(const AccessorReader& reader, const std::string& place) const {
    const int type = reader.componentType();
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      document_.refuse(reader.place() + "/componentType",
                       "is " + std::to_string(type) + "; indices are 5121, 5123 or 5125");
    }
    document_.charge(reader.count() * sizeof(std::uint32_t) * 3,
                     place);  // a strip has thrice as many corners
    std::vector<std::uint32_t> corners(reader.count());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      reader.readWhole(i, 1, &corners[i]);
      if (corners[i] >= vertexCount_) {
        document_.refuse(place, "element " + std::to_string(i) + " of accessor " +
                                    std::to_string(source_.indices) + " is " + std::to_string(corners[i]) +
                                    ", but there are only " + std::to_string(vertexCount_) +
                                    " vertices, counted from 0");
      }
    }
    return corners;
  }

  /// Renumbers `indices` to the vertices in use and returns those, ascending.
  Elements compact(std::vector<std::uint32_t>& indices) const {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    document_.charge(vertexCount_ * sizeof(std::uint32_t), attributePlace("POSITION"));
    std::vector<std::uint32_t> number(vertexCount_, kUnused);
    for (const std::uint32_t i : indices) number[i] = 0;
    Elements used;
    for (std::size_t v = 0; v < vertexCount_; ++v) {
      if (number[v] == kUnused) continue;
      number[v] = static_cast<std::uint32_t>(used.size());
      used.push_back(static_cast<std::uint32_t>(v));
    }
    for (std::uint32_t& i : indices) i = number[i];
    return used;
  }

  void readVertices(PrimitiveArrays& arrays, int texcoordSet) const {
    arrays.positions = readAttribute<glm::vec3>("POSITION", TINYGLTF_TYPE_VEC3);
    arrays.normals = readAttribute<glm::vec3>("NORMAL", TINYGLTF_TYPE_VEC3);
    arrays.texcoords =
        readAttribute<glm::vec2>("TEXCOORD_" + std::to_string(texcoordSet), TINYGLTF_TYPE_VEC2);
    arrays.tangents = readAttribute<glm::vec4>("TANGENT", TINYGLTF_TYPE_VEC4);
    for (glm::vec4& t : arrays.tangents) t.w = t.w < 0.0f ? -1.0f : 1.0f;
    readColors(arrays);
  }

  void readColors(PrimitiveArrays& arrays) const {
    const auto found = source_.attributes.find("COLOR_0");
    if (found == source_.attributes.end()) return;
    const AccessorReader reader =
        vertexReader(found->second, attributePlace("COLOR_0"), TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC3);
    if (reader.components() == 4) {
      arrays.colors = gather<glm::vec4>(document_, reader, elements_);
    } else {
      for (const glm::vec3& rgb : gather<glm::vec3>(document_, reader, elements_))
        arrays.colors.emplace_back(rgb, 1.0f);
    }
    constexpr float kBrightest = 1024.0f;
    for (glm::vec4& color : arrays.colors) {
      for (int c = 0; c < 4; ++c) color[c] = std::clamp(color[c], 0.0f, c == 3 ? 1.0f : kBrightest);
    }
  }

  void readSkinning(PrimitiveArrays& arrays) const {
    for (const char* set : {"0", "1"}) {
      const auto joints = source_.attributes.find(std::string("JOINTS_") + set);
      const auto weights = source_.attributes.find(std::string("WEIGHTS_") + set);
      if (joints == source_.attributes.end() || weights == source_.attributes.end()) break;
      SkinBinding binding;
      binding.weights = gather<glm::vec4>(
          document_, vertexReader(weights->second, attributePlace(weights->first), TINYGLTF_TYPE_VEC4),
          elements_);
      binding.joints = readJoints(joints->first, joints->second);
      arrays.skinning.push_back(std::move(binding));
    }
    if (!arrays.skinning.empty()) normalizeWeights(arrays.skinning);
  }

  std::vector<std::array<std::uint16_t, 4>> readJoints(const std::string& name, int accessor) const {
    const AccessorReader reader = vertexReader(accessor, attributePlace(name), TINYGLTF_TYPE_VEC4);
    const int type = reader.componentType();
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
      document_.refuse(reader.place() + "/componentType",
                       "is " + std::to_string(type) + "; joints are 5121 or 5123");
    }
    const std::size_t count = elements_ ? elements_->size() : vertexCount_;
    document_.charge(count * sizeof(std::array<std::uint16_t, 4>), reader.place());
    std::vector<std::array<std::uint16_t, 4>> joints(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::uint32_t, 4> whole{};
      reader.readWhole(elements_ ? (*elements_)[i] : i, 4, whole.data());
      for (std::size_t k = 0; k < 4; ++k) joints[i][k] = static_cast<std::uint16_t>(whole[k]);
    }
    return joints;
  }

  /// Old but real files have weights that do not add up to one: they are divided by their sum.
  void normalizeWeights(std::vector<SkinBinding>& sets) const {
    constexpr float kRounding = 0.02f;  // four weights of eight bits
    for (std::size_t v = 0; v < sets[0].weights.size(); ++v) {
      float sum = 0.0f;
      for (SkinBinding& set : sets) {
        for (int k = 0; k < 4; ++k) sum += set.weights[v][k] = std::max(set.weights[v][k], 0.0f);
      }
      if (sum <= 0.0f) {
        sets[0].weights[v].x = 1.0f;
        sum = 1.0f;
        ++report_.withoutWeights;
      } else if (std::abs(sum - 1.0f) > kRounding) {
        ++report_.unnormalizedWeights;
      }
      for (SkinBinding& set : sets) {
        for (int k = 0; k < 4; ++k) {
          set.weights[v][k] /= sum;
          if (set.weights[v][k] == 0.0f) set.joints[v][static_cast<std::size_t>(k)] = 0;  // may name no joint
        }
      }
    }
  }

  void readTargets(PrimitiveArrays& arrays) const {
    for (std::size_t t = 0; t < source_.targets.size(); ++t) {
      const auto offsets = [&](const char* name) -> std::vector<glm::vec3> {
        const auto found = source_.targets[t].find(name);
        if (found == source_.targets[t].end()) return {};
        const std::string place = place_ + jsonPointer("targets", t, name);
        return gather<glm::vec3>(document_, vertexReader(found->second, place, TINYGLTF_TYPE_VEC3),
                                 elements_);
      };
      MorphTarget& target = arrays.targets.emplace_back();
      target.positions = offsets("POSITION");
      target.normals = offsets("NORMAL");
      target.tangents = offsets("TANGENT");
    }
  }

  GltfDocument& document_;
  const tinygltf::Primitive& source_;
  std::string place_;
  PrimitiveReport& report_;
  std::size_t vertexCount_ = 0;
  const Elements* elements_ = nullptr;  ///< null: all vertices are in use
};

}  // namespace

std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    // glTF 2.0, 3.7.2.1: strip p_i = {v_i, v_(i+1+i%2), v_(i+2-i%2)}, fan p_i = {v_(i+1), v_(i+2), v_0}.
    const bool isFan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const std::uint32_t a = corners[isFan ? i + 1 : i];
    const std::uint32_t b = corners[isFan ? i + 2 : i + 1 + i % 2];
    const std::uint32_t c = corners[isFan ? 0 : i + 2 - i % 2];
    if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
  }
  return triangles;
}

PrimitiveArrays readPrimitive(GltfDocument& document, std::size_t mesh, std::size_t primitive,
                              int texcoordSet, PrimitiveReport& report) {
  return PrimitiveReader(document, mesh, primitive, report).read(texcoordSet);
}

}  // namespace limn::scene
