// Based on: glTF 2.0 specification, section 3.7.3 "Skins".
#include <algorithm>
#include <array>

#include "apps/scene/gltf_accessor.h"
#include "apps/scene/gltf_nodes.h"

namespace limn::scene {
namespace {

Skin readSkin(GltfDocument& document, std::size_t index, const std::vector<std::uint32_t>& nodeOf) {
  const tinygltf::Skin& source = document.model.skins[index];
  Skin skin;
  if (source.joints.empty())
    document.refuse(jsonPointer("skins", index, "joints"), "is empty; a skin has at least one joint");
  for (const int joint : source.joints) skin.joints.push_back(nodeOf[static_cast<std::size_t>(joint)]);
  document.charge(skin.joints.size() * sizeof(glm::dmat4), jsonPointer("skins", index, "joints"));
  skin.inverseBind.resize(skin.joints.size(), glm::dmat4(1.0));
  if (source.inverseBindMatrices < 0) return skin;

  const std::string place = jsonPointer("skins", index, "inverseBindMatrices");
  const AccessorReader reader(document, source.inverseBindMatrices);
  if (reader.components() != 16 || reader.componentType() != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    document.refuse(
        place, "accessor " + std::to_string(source.inverseBindMatrices) + " holds no matrices of 16 floats");
  }
  if (reader.count() < skin.joints.size()) {
    document.refuse(place, std::to_string(reader.count()) + " matrices for " +
                               std::to_string(skin.joints.size()) + " joints");
  }
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    std::array<float, 16> values{};
    reader.read(j, values.size(), values.data());
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 3; ++r)
        skin.inverseBind[j][c][r] = static_cast<double>(values[static_cast<std::size_t>(4 * c + r)]);
    }
  }
  return skin;
}

std::size_t largestJoint(const Mesh& mesh) {
  std::size_t largest = 0;
  for (const SkinBinding& set : mesh.skinning) {
    for (const std::array<std::uint16_t, 4>& joints : set.joints) {
      largest = std::max<std::size_t>(largest, *std::max_element(joints.begin(), joints.end()));
    }
  }
  return largest;
}

}  // namespace

void readSkins(GltfDocument& document, const std::vector<std::uint32_t>& nodeOf, Scene& scene) {
  for (std::size_t i = 0; i < document.model.skins.size(); ++i)
    scene.skins.push_back(readSkin(document, i, nodeOf));
  std::vector<std::size_t> largestJoints;
  for (const Mesh& mesh : scene.meshes) largestJoints.push_back(largestJoint(mesh));
  for (std::size_t n = 0; n < nodeOf.size(); ++n) {
    Node& node = scene.nodes[nodeOf[n]];
    if (node.skin < 0) continue;
    if (node.mesh < 0 || scene.meshes[static_cast<std::size_t>(node.mesh)].skinning.empty()) {
      node.skin = -1;
      document.notice("Node " + std::to_string(n) +
                      ": a skin without a mesh that has joints and weights was left out.");
      continue;
    }
    const std::size_t largest = largestJoints[static_cast<std::size_t>(node.mesh)];
    const std::size_t joints = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
    if (largest < joints) continue;
    document.refuse(jsonPointer("nodes", n, "skin"), "mesh " + std::to_string(node.mesh) + " uses joint " +
                                                         std::to_string(largest) + ", but skin " +
                                                         std::to_string(node.skin) + " has only " +
                                                         std::to_string(joints) + ", counted from 0");
  }
}

}  // namespace limn::scene
