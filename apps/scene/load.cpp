#include "apps/scene/load.h"

#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "apps/scene/builtin.h"
#include "apps/scene/gltf_load.h"
#include "apps/scene/input_file.h"

namespace limn::scene {
namespace {

namespace fs = std::filesystem;

ModelFile readStandardInput() {
  return {"standard input",
          {std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()},
          std::nullopt};
}

ModelFile readNamed(const std::string& name) {
  const fs::path path(name);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw InputError(
        name + ": there is no such file; built-in models are named builtin:NAME, `limn models` lists them");
  }
  if (!fs::is_regular_file(status)) throw InputError(name + ": is not a file; name a .gltf or .glb file");
  std::optional<std::vector<std::uint8_t>> bytes = readFileBytes(path);
  if (!bytes) throw InputError(name + ": cannot be read; may you read it?");
  return {name, std::move(*bytes), path.has_parent_path() ? path.parent_path() : fs::path(".")};
}

/// What `model` names beyond "builtin:", if it does.
std::optional<std::string> builtinName(const std::string& model) {
  const std::string prefix = "builtin:";
  if (!model.starts_with(prefix)) return std::nullopt;
  return model.substr(prefix.size());
}

}  // namespace

Scene load(const std::string& model, const LoadOptions& options) {
  if (const auto name = builtinName(model)) return makeBuiltin(*name);
  ModelFile file = model == "-" ? readStandardInput() : readNamed(model);
  return loadGltf(file.name, std::move(file.bytes), file.folder, options);
}

Source openSource(const std::string& model, const LoadOptions& options) {
  if (const auto name = builtinName(model)) return {{model, {}, std::nullopt}, makeBuiltin(*name)};
  ModelFile file = model == "-" ? readStandardInput() : readNamed(model);
  Scene scene = loadGltf(file.name, file.bytes, file.folder, options);
  return {std::move(file), std::move(scene)};
}

}  // namespace limn::scene
