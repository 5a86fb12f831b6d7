// glTF 2.0 in, Scene out; and the built-in models.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/scene/scene.h"

namespace limn::scene {

/// What is wrong with an input file: "FILE: PLACE: what; remedy". The program ends with exit status 3.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LoadOptions {
  double creaseDegrees = 40.0;  ///< for meshes without normals: edges that turn more are split
};

/// Loads MODEL as the command line names it: a .gltf or .glb file, "-" (GLB on standard input) or "builtin:NAME".
/// Throws InputError; an unknown built-in name is answered with the nearest known one.
Scene load(const std::string& model, const LoadOptions& options = {});

/// The bytes of a model's file; built-in models have none.
struct ModelFile {
  std::string name;  ///< what messages call it
  std::vector<std::uint8_t> bytes;
  std::optional<std::filesystem::path>
      folder;  ///< where the files lie that it refers to; none for standard input
};

/// A scene, and the file that it came from for those who write parts of it again.
struct Source {
  ModelFile file;
  Scene scene;
};

/// As load().
Source openSource(const std::string& model, const LoadOptions& options = {});

struct BuiltinModel {
  std::string name;  ///< after "builtin:"
  std::string description;
};
std::vector<BuiltinModel> builtinModels();

}  // namespace limn::scene
