// Refined meshes as a GLB file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/scene/frame.h"
#include "apps/scene/scene.h"

namespace limn::scene {

struct ExportOptions {
  /// Adds the coarse mesh's edges as lines with their silhouetteness in the vertex attribute _ALPHA.
  bool alphas = false;
  std::string generator;  ///< for the asset block
};

/// The last frame that `drawer` refined or drew as a glTF 2.0 binary: one mesh per instance, what the stream does not
/// replace and the stream, with positions, normals (unit) and, where the mesh has them, texture coordinates and colours;
/// materials without their textures.
std::vector<std::uint8_t> exportRefined(const Scene& scene, const Pose& pose, FrameDrawer& drawer,
                                        const ExportOptions& options);

}  // namespace limn::scene
