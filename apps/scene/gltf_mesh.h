// glTF meshes: all primitives of one in one set of arrays.
#pragma once

#include "apps/scene/gltf_document.h"
#include "apps/scene/scene.h"

namespace limn::scene {

/// Reads mesh `index`. Normals that are missing are made and split at `creaseDegrees`. Parts refer to
/// materials as the file numbers them, and to `materials.size()` where it gives none. Throws InputError.
Mesh readMesh(GltfDocument& document, std::size_t index, double creaseDegrees);

}  // namespace limn::scene
