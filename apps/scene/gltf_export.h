// Refined meshes as a GLB file.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"

namespace limn::scene {

struct ExportOptions {
  /// Adds the coarse mesh's edges as lines with their silhouetteness in the vertex attribute _ALPHA.
  bool alphas = false;
  std::string generator;  ///< for the asset block
};

/// Appends the materials of a built-in model to a glTF document, as far as glTF can say them.
void addBuiltinMaterials(const Scene& scene, nlohmann::ordered_json& root);

/// The last frame that `drawer` refined or drew as a glTF 2.0 binary: one mesh per instance, what the stream does not
/// replace and the stream, with positions, normals (unit) and, where the mesh has them, tangents, texture coordinates and
/// colours. The materials are the file's, with their textures and pictures; a built-in model's colours stand in for its.
std::vector<std::uint8_t> exportRefined(const Source& source, const Pose& pose, FrameDrawer& drawer,
                                        const ExportOptions& options);

}  // namespace limn::scene
