// The small model as a file: the fine file with other meshes, or the user's coarse file with curves added.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene/scene.h"

namespace limn::coarsen {

/// A model with the bytes of its file at hand; built-in models have none.
struct Source {
  std::string name;
  std::vector<std::uint8_t> bytes;
  std::optional<std::filesystem::path> folder;
  scene::Scene scene;
};

/// Reads MODEL as the command line names it. Throws InputError.
Source openSource(const std::string& model);

/// A GLB with everything of the source file (nodes, materials, pictures, skins, animations, whatever limn does not know)
/// but for its meshes: those are scene::Mesh with their curves. Pictures in files beside it come into the GLB.
std::vector<std::uint8_t> withMeshes(const Source& source, const std::vector<scene::Mesh>& meshes);

/// A GLB with everything of the source file, and the meshes' curves.
std::vector<std::uint8_t> withCurves(const Source& source, const std::vector<scene::Mesh>& meshes);

}  // namespace limn::coarsen
