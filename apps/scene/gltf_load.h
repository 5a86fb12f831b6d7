// glTF 2.0 to Scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene/load.h"

namespace limn::scene {

/// Loads a .gltf or .glb whose bytes are at hand. `file` names it in messages; external files are looked for
/// in `folder`. Throws InputError.
Scene loadGltf(const std::string& file, std::vector<std::uint8_t> bytes,
               const std::optional<std::filesystem::path>& folder, const LoadOptions& options);

}  // namespace limn::scene
