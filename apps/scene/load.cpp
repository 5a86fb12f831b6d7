#include "apps/scene/load.h"

#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "apps/scene/builtin.h"
#include "apps/scene/gltf_load.h"
#include "apps/scene/gltf_uri.h"

namespace limn::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestFile = std::size_t{1} << 40;

Scene loadStandardInput(const LoadOptions& options) {
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
  return loadGltf("standard input", std::move(bytes), std::nullopt, options);
}

Scene loadFile(const std::string& name, const LoadOptions& options) {
  const fs::path path(name);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw InputError(
        name + ": there is no such file; built-in models are named builtin:NAME, `limn models` lists them");
  }
  if (!fs::is_regular_file(status)) throw InputError(name + ": is not a file; name a .gltf or .glb file");
  std::optional<std::vector<std::uint8_t>> bytes = readFileBytes(path, kLargestFile);
  if (!bytes) throw InputError(name + ": cannot be read; may you read it?");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  return loadGltf(name, std::move(*bytes), folder, options);
}

}  // namespace

Scene load(const std::string& model, const LoadOptions& options) {
  const std::string prefix = "builtin:";
  if (model.starts_with(prefix)) return makeBuiltin(model.substr(prefix.size()));
  return model == "-" ? loadStandardInput(options) : loadFile(model, options);
}

}  // namespace limn::scene
