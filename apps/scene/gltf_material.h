// glTF materials and textures as the rasterizer's; docs/materials.md says how and why.
#pragma once

#include "apps/scene/gltf_document.h"
#include "apps/scene/scene.h"

namespace limn::scene {

/// Fills scene.materials (the default one last) and scene.textures: the images of those materials that scene.meshes use.
/// Throws InputError for images that are missing, damaged, neither PNG nor JPEG, or too large.
void readMaterials(GltfDocument& document, Scene& scene);

/// Blinn–Phong factors for metallic-roughness ones (all clamped to [0, 1]).
raster::Material blinnPhongOf(const glm::vec4& baseColor, double metallic, double roughness);

}  // namespace limn::scene
