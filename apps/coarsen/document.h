// The small model as a file: the fine file with other meshes, or the user's coarse file with curves added.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/scene/load.h"

namespace limn::coarsen {

/// A GLB with everything of the source file (nodes, materials, pictures, skins, animations, whatever limn does not know)
/// but for its meshes: those are scene::Mesh with their curves. Pictures in files beside it come into the GLB.
std::vector<std::uint8_t> withMeshes(const scene::Source& source, const std::vector<scene::Mesh>& meshes);

/// A GLB with everything of the source file, and the meshes' curves.
std::vector<std::uint8_t> withCurves(const scene::Source& source, const std::vector<scene::Mesh>& meshes);

}  // namespace limn::coarsen
