#include "apps/scene/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "apps/scene/gltf_fitted.h"
#include "apps/scene/gltf_primitive.h"
#include "apps/scene/gltf_texture.h"
#include "apps/scene/mesh_normals.h"

namespace limn::scene {
namespace {

const glm::vec3 kUp(0.0f, 0.0f, 1.0f);  // the normal of what has none

class MeshReader {
 public:
  MeshReader(GltfDocument& document, std::size_t index, double creaseDegrees)
      : document_(document), index_(index), creaseDegrees_(creaseDegrees) {}

  Mesh read() {
    const tinygltf::Mesh& source = document_.model.meshes[index_];
    mesh_.name = source.name;
    for (std::size_t p = 0; p < source.primitives.size(); ++p) {
      append(readPrimitive(document_, index_, p, texcoordSet(source.primitives[p]), report_),
             source.primitives[p]);
    }
    const std::vector<glm::vec3> corners =
        source.extensions.empty() ? std::vector<glm::vec3>{} : cornerPositions();
    rebase();
    makeMissingNormals();
    mendNormals();
    readFittedCurves(document_, index_, corners, mesh_);
    readWeights(source);
    giveNotices();
    return std::move(mesh_);
  }

 private:
  /// Appends `more` (empty or one per new vertex) to `all`; whichever of the two is missing is filled up.
  template <class T>
  void appendFilled(std::vector<T>& all, std::vector<T>&& more, std::size_t before, std::size_t added,
                    const T& filler) {
    if (all.empty() && more.empty()) return;
    if (all.empty() && before == 0) {
      all = std::move(more);
      return;
    }
    const std::size_t filled = before - std::min(before, all.size()) + added - more.size();
    document_.charge(filled * sizeof(T), jsonPointer("meshes", index_));
    all.resize(before, filler);
    all.insert(all.end(), more.begin(), more.end());
    all.resize(before + added, filler);
  }

  std::vector<glm::vec3> cornerPositions() {
    document_.charge(mesh_.indices.size() * sizeof(glm::vec3), jsonPointer("meshes", index_));
    std::vector<glm::vec3> corners;
    corners.reserve(mesh_.indices.size());
    for (const std::uint32_t vertex : mesh_.indices) corners.push_back(mesh_.positions[vertex]);
    return corners;
  }

  /// The texture coordinates that the base colour wants, or else the first texture that the material has.
  int texcoordSet(const tinygltf::Primitive& primitive) const {
    if (!hasTexture(primitive)) return 0;
    const tinygltf::Material& material =
        document_.model.materials[static_cast<std::size_t>(primitive.material)];
    const auto& base = material.pbrMetallicRoughness.baseColorTexture;
    if (base.index >= 0) return texcoordSetOf(base);
    if (material.normalTexture.index >= 0) return texcoordSetOf(material.normalTexture);
    return texcoordSetOf(material.emissiveTexture);
  }

  bool hasTexture(const tinygltf::Primitive& primitive) const {
    if (primitive.material < 0) return false;
    const tinygltf::Material& material =
        document_.model.materials[static_cast<std::size_t>(primitive.material)];
    return material.pbrMetallicRoughness.baseColorTexture.index >= 0 || material.normalTexture.index >= 0 ||
           material.emissiveTexture.index >= 0;
  }

  void append(PrimitiveArrays&& arrays, const tinygltf::Primitive& source) {
    if (arrays.indices.empty()) return;
    if (arrays.texcoords.empty() && hasTexture(source)) ++report_.withoutTexcoords;
    const std::size_t before = mesh_.positions.size(), added = arrays.positions.size();
    if (before + added > std::numeric_limits<std::int32_t>::max()) {
      document_.refuse(jsonPointer("meshes", index_), "has more than 2147483647 vertices; split it");
    }
    if (arrays.normals.empty()) {
      for (std::size_t i = 0; i < arrays.indices.size(); ++i) {
        cornersWithoutNormals_.push_back(static_cast<std::uint32_t>(mesh_.indices.size() + i));
      }
    }
    appendTargets(std::move(arrays.targets), before, added);
    appendSkinning(std::move(arrays.skinning), before, added);
    appendFilled(mesh_.normals, std::move(arrays.normals), before, added, glm::vec3(0.0f));
    appendFilled(mesh_.texcoords, std::move(arrays.texcoords), before, added, glm::vec2(0.0f));
    appendFilled(mesh_.colors, std::move(arrays.colors), before, added, glm::vec4(1.0f));
    appendFilled(mesh_.tangents, std::move(arrays.tangents), before, added, glm::vec4(0.0f));
    appendFilled(mesh_.positions, std::move(arrays.positions), before, added, glm::vec3(0.0f));
    appendTriangles(std::move(arrays.indices), before, source.material);
  }

  void appendTriangles(std::vector<std::uint32_t>&& indices, std::size_t before, int material) {
    const std::uint32_t first = static_cast<std::uint32_t>(mesh_.indices.size() / 3);
    const std::uint32_t count = static_cast<std::uint32_t>(indices.size() / 3);
    for (std::uint32_t& i : indices) i += static_cast<std::uint32_t>(before);
    if (mesh_.indices.empty())
      mesh_.indices = std::move(indices);
    else
      mesh_.indices.insert(mesh_.indices.end(), indices.begin(), indices.end());
    const std::uint32_t drawn = static_cast<std::uint32_t>(
        material < 0 ? static_cast<int>(document_.model.materials.size()) : material);
    if (!mesh_.parts.empty() && mesh_.parts.back().material == drawn)
      mesh_.parts.back().triangleCount += count;
    else
      mesh_.parts.push_back({first, count, drawn});
  }

  /// A primitive with fewer targets than its neighbours does not move with the others.
  void appendTargets(std::vector<MorphTarget>&& targets, std::size_t before, std::size_t added) {
    mesh_.targets.resize(std::max(mesh_.targets.size(), targets.size()));
    targets.resize(mesh_.targets.size());
    for (std::size_t t = 0; t < targets.size(); ++t) {
      appendFilled(mesh_.targets[t].positions, std::move(targets[t].positions), before, added,
                   glm::vec3(0.0f));
      appendFilled(mesh_.targets[t].normals, std::move(targets[t].normals), before, added, glm::vec3(0.0f));
      appendFilled(mesh_.targets[t].tangents, std::move(targets[t].tangents), before, added, glm::vec3(0.0f));
    }
  }

  /// A primitive without weights among skinned ones follows the first joint.
  void appendSkinning(std::vector<SkinBinding>&& sets, std::size_t before, std::size_t added) {
    mesh_.skinning.resize(std::max(mesh_.skinning.size(), sets.size()));
    sets.resize(mesh_.skinning.size());
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const glm::vec4 filler(s == 0 ? 1.0f : 0.0f, 0.0f, 0.0f, 0.0f);
      appendFilled(mesh_.skinning[s].weights, std::move(sets[s].weights), before, added, filler);
      appendFilled(mesh_.skinning[s].joints, std::move(sets[s].joints), before, added, {});
    }
  }

  /// Far from the origin floats have no digits left for the shape, and squares of huge numbers overflow.
  void rebase() {
    constexpr double kFar = 4.0;  // times the extent: two of 24 bits are lost at most
    constexpr double kHuge = 1e4, kTiny = 1e-4;
    if (mesh_.positions.empty()) return;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::vec3& p : mesh_.positions) {
      low = glm::min(low, glm::dvec3(p));
      high = glm::max(high, glm::dvec3(p));
    }
    const glm::dvec3 center = 0.5 * (low + high), half = 0.5 * (high - low);
    const double extent = std::max({half.x, half.y, half.z});
    const double distance = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    if (distance > kFar * extent) mesh_.origin = center;
    const double reach = std::max(extent, farthestTarget());
    if (reach > kHuge || (reach > 0.0 && reach < kTiny)) {
      int exponent = 0;
      std::frexp(reach, &exponent);
      mesh_.scale = std::ldexp(1.0, exponent);
    }
    if (mesh_.origin == glm::dvec3(0.0) && mesh_.scale == 1.0) return;
    for (glm::vec3& p : mesh_.positions) p = glm::vec3((glm::dvec3(p) - mesh_.origin) / mesh_.scale);
    for (MorphTarget& target : mesh_.targets) {
      for (glm::vec3& p : target.positions) p = glm::vec3(glm::dvec3(p) / mesh_.scale);
    }
  }

  /// The largest coordinate of all targets: beside it the mesh itself may be tiny.
  double farthestTarget() const {
    double farthest = 0.0;
    for (const MorphTarget& target : mesh_.targets)
      for (const glm::vec3& p : target.positions)
        farthest = std::max({farthest, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
    return farthest;
  }

  void makeMissingNormals() {
    if (cornersWithoutNormals_.empty()) return;
    document_.charge(cornersWithoutNormals_.size() * 120,
                     jsonPointer("meshes", index_));  // what grouping takes
    const NormalGroups groups =
        groupCorners(mesh_.positions, mesh_.indices, std::move(cornersWithoutNormals_), creaseDegrees_);
    appendCopies(groups.copies);
    mesh_.normals.resize(mesh_.positions.size());
    makeNormals(groups, mesh_.positions, mesh_.indices, kUp, mesh_.normals);
    for (MorphTarget& target : mesh_.targets) makeTargetNormals(groups, target);
  }

  void appendCopies(const std::vector<std::uint32_t>& copies) {
    const auto extend = [&](auto& array) {
      if (array.empty()) return;
      document_.charge(copies.size() * sizeof(array[0]), jsonPointer("meshes", index_));
      array.reserve(array.size() + copies.size());
      for (const std::uint32_t v : copies) array.push_back(array[v]);
    };
    extend(mesh_.positions);
    extend(mesh_.normals);
    extend(mesh_.texcoords);
    extend(mesh_.colors);
    extend(mesh_.tangents);
    for (SkinBinding& set : mesh_.skinning) {
      extend(set.joints);
      extend(set.weights);
    }
    for (MorphTarget& target : mesh_.targets) {
      extend(target.positions);
      extend(target.normals);
      extend(target.tangents);
    }
  }

  /// How the made normals change with the target; the file can say nothing of that.
  void makeTargetNormals(const NormalGroups& groups, MorphTarget& target) {
    if (target.positions.empty()) return;
    document_.charge(mesh_.positions.size() * 3 * sizeof(glm::vec3), jsonPointer("meshes", index_));
    std::vector<glm::vec3> moved(mesh_.positions), normals(mesh_.normals);
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] += target.positions[v];
    makeNormals(groups, moved, mesh_.indices, kUp, normals);
    target.normals.resize(mesh_.positions.size(), glm::vec3(0.0f));
    for (const std::uint32_t corner : groups.corners) {
      const std::uint32_t v = mesh_.indices[corner];
      target.normals[v] = normals[v] - mesh_.normals[v];
    }
  }

  /// Makes normals and tangents unit vectors; those of no length get the one that would be made, or any.
  void mendNormals() {
    std::vector<bool> isBroken(mesh_.normals.size(), false);
    std::size_t broken = 0;
    for (std::size_t v = 0; v < mesh_.normals.size(); ++v) {
      const double length = glm::length(glm::dvec3(mesh_.normals[v]));
      isBroken[v] = !(length > 1e-18);
      if (isBroken[v])
        ++broken;
      else if (std::abs(length - 1.0) > 1e-6)
        mesh_.normals[v] = glm::vec3(glm::dvec3(mesh_.normals[v]) / length);
    }
    if (broken > 0) {
      NormalGroups all;  // every vertex is a group of its own
      all.corners.resize(mesh_.indices.size());
      std::iota(all.corners.begin(), all.corners.end(), 0U);
      all.groups = mesh_.indices;
      std::vector<glm::vec3> made(mesh_.normals.size());
      makeNormals(all, mesh_.positions, mesh_.indices, kUp, made);
      for (std::size_t v = 0; v < made.size(); ++v) {
        if (isBroken[v]) mesh_.normals[v] = made[v];
      }
      document_.notice(named() + std::to_string(broken) + " normals of length 0 were replaced.");
    }
    for (glm::vec4& tangent : mesh_.tangents) {
      const double length = glm::length(glm::dvec3(tangent));
      if (length > 1e-18) tangent = glm::vec4(glm::vec3(glm::dvec3(tangent) / length), tangent.w);
    }
  }

  void readWeights(const tinygltf::Mesh& source) {
    mesh_.weights.assign(mesh_.targets.size(), 0.0f);
    for (std::size_t t = 0; t < std::min(source.weights.size(), mesh_.weights.size()); ++t) {
      mesh_.weights[t] = static_cast<float>(source.weights[t]);
    }
    if (!source.weights.empty() && source.weights.size() != mesh_.targets.size()) {
      document_.notice(named() + std::to_string(source.weights.size()) + " weights for " +
                       std::to_string(mesh_.targets.size()) + " morph targets.");
    }
  }

  std::string named() const { return "Mesh " + std::to_string(index_) + ": "; }

  void giveNotices() {
    const auto tell = [&](std::size_t count, const char* what) {
      if (count > 0) document_.notice(named() + std::to_string(count) + what);
    };
    tell(report_.pointsAndLines, " primitives of points or lines were left out.");
    tell(report_.withoutPositions, " primitives without positions were left out.");
    tell(report_.cutShort, " primitives end within a triangle.");
    tell(report_.withoutTexcoords,
         " primitives have a texture but no coordinates for it; they show its corner alone.");
    tell(report_.unnormalizedWeights,
         " vertices have joint weights that do not add up to 1; they were scaled.");
    tell(report_.withoutWeights, " vertices have no joint weights; they follow the first joint.");
  }

  GltfDocument& document_;
  std::size_t index_;
  double creaseDegrees_;
  Mesh mesh_;
  PrimitiveReport report_;
  std::vector<std::uint32_t> cornersWithoutNormals_;
};

}  // namespace

Mesh readMesh(GltfDocument& document, std::size_t index, double creaseDegrees) {
  return MeshReader(document, index, creaseDegrees).read();
}

}  // namespace limn::scene
