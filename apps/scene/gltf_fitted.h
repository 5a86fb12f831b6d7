// The extension LIMN_fitted_curves: docs/fitted-curves.md.
#pragma once

#include "apps/scene/glb_builder.h"
#include "apps/scene/gltf_document.h"
#include "apps/scene/scene.h"

namespace limn::scene {

inline constexpr const char* kFittedCurvesName = "LIMN_fitted_curves";

/// Reads the fitted curves of mesh `index` into mesh.curves, where the file has some. `corners`: the positions of the
/// triangles' corners, three per triangle, as the file has them. Curves that do not belong to the mesh as it is, or whose bytes changed since they
/// were written, are left out with a notice.
void readFittedCurves(GltfDocument& document, std::size_t index, std::span<const glm::vec3> corners,
                      Mesh& mesh);

/// The extension's object for a mesh with these corners; adds its arrays.
nlohmann::ordered_json writeFittedCurves(GlbBuilder& builder, const StoredCurves& curves,
                                         std::span<const glm::vec3> corners);

}  // namespace limn::scene
