// glTF nodes, scenes, cameras, lights, skins and animations.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/scene/gltf_document.h"
#include "apps/scene/scene.h"

namespace limn::scene {

/// Fills scene.nodes (parents first), scene.inScene, cameras and lights; scene.meshes are there already.
/// Returns for each node of the file its place in scene.nodes. Throws InputError for cycles and nodes with two
/// parents.
std::vector<std::uint32_t> readNodes(GltfDocument& document, Scene& scene);

/// Fills scene.skins and checks that the meshes' joints are there.
void readSkins(GltfDocument& document, const std::vector<std::uint32_t>& nodeOf, Scene& scene);

/// Fills scene.animations.
void readAnimations(GltfDocument& document, const std::vector<std::uint32_t>& nodeOf, Scene& scene);

/// Refuses a scene, complete but for its poses, whose nodes multiply to numbers that no double can square.
void checkWorldTransforms(const GltfDocument& document, const Scene& scene,
                          const std::vector<std::uint32_t>& nodeOf);

}  // namespace limn::scene
