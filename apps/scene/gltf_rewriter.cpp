#include "apps/scene/gltf_rewriter.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "apps/scene/gltf_container.h"
#include "apps/scene/gltf_uri.h"
#include "apps/scene/input_file.h"

namespace limn::scene {
namespace {

using Json = GltfRewriter::Json;

Json& listOf(Json& json, const char* name) {
  static Json none = Json::array();
  const auto found = json.find(name);
  return found != json.end() && found->is_array() ? *found : none;
}

/// The number of a set, as the loader takes it; 0 for what is none, which stands where the loader does not look.
int setOf(const Json& json) {
  constexpr double kLastSet = 255.0;
  const double number = json.is_number() ? json.get<double>() : 0.0;
  return number >= 0.0 && number <= kLastSet ? static_cast<int>(number) : 0;
}

/// Extensions that limn does not know are kept, so the sets that they ask for are kept too; nothing draws extras.
int highestSet(const Json& json) {
  int highest = 0;
  for (const auto& item : json.items()) {
    if (item.key() == "texCoord")
      highest = std::max(highest, setOf(item.value()));
    else if (item.value().is_structured() && item.key() != "extras")
      highest = std::max(highest, highestSet(item.value()));
  }
  return highest;
}

/// The extensions of a list that `text` names.
Json namedIn(const std::string& text, const Json& extensions) {
  Json named = Json::array();
  for (const Json& extension : extensions)
    if (text.find(extension.dump()) != std::string::npos) named.push_back(extension);
  return named;
}

}  // namespace

GltfRewriter::GltfRewriter(const ModelFile& file) : document_(file.name, file.bytes, file.folder) {
  std::vector<std::string> notices;
  Json json = Json::parse(splitContainer(file.name, file.bytes, notices).json);
  oldAccessors_ = json.value("accessors", Json::array());
  oldViews_ = json.value("bufferViews", Json::array());
  for (const char* name : {"accessors", "bufferViews", "buffers"}) json.erase(name);
  newAccessor_.assign(oldAccessors_.size(), -1);
  newView_.assign(oldViews_.size(), -1);
  setRoot(std::move(json));
}

/// With lists for what is brought over, whose members would move if the lists came later: others hold references to them.
void GltfRewriter::setRoot(Json json) {
  for (const char* name : {"accessors", "bufferViews"}) json[name] = Json::array();
  root() = std::move(json);
}

void GltfRewriter::keepRest() {
  for (Json& skin : listOf(root(), "skins")) keepAccessor(skin, "inverseBindMatrices");
  for (Json& animation : listOf(root(), "animations"))
    for (Json& sampler : listOf(animation, "samplers")) {
      keepAccessor(sampler, "input");
      keepAccessor(sampler, "output");
    }
  keepImages();
}

void GltfRewriter::keepMaterialsOnly() {
  Json kept = {{"asset", root()["asset"]}};
  for (const char* name : {"materials", "textures", "samplers", "images"})
    if (root().contains(name)) kept[name] = root()[name];
  const std::string text = kept.dump();
  for (const char* name : {"extensionsUsed", "extensionsRequired"}) {
    const Json named = namedIn(text, listOf(root(), name));
    if (!named.empty()) kept[name] = named;
  }
  setRoot(std::move(kept));
  keepImages();
}

void GltfRewriter::keepMesh(std::size_t index) {
  const auto keepAttributes = [&](Json& attributes) {
    for (auto& attribute : attributes.items())
      attribute.value() = accessor(attribute.value().get<std::size_t>());
  };
  for (Json& primitive : listOf(root()["meshes"][index], "primitives")) {
    keepAccessor(primitive, "indices");
    keepAttributes(primitive["attributes"]);
    for (Json& target : listOf(primitive, "targets")) keepAttributes(target);
  }
}

/// Brings over what `json[name]` refers to and changes the reference.
void GltfRewriter::keepAccessor(Json& json, const char* name) {
  if (json.contains(name)) json[name] = accessor(json[name].get<std::size_t>());
}

void GltfRewriter::keepView(Json& json, const char* name) {
  if (json.contains(name)) json[name] = view(json[name].get<std::size_t>());
}

void GltfRewriter::keepImages() {
  std::size_t index = 0;
  for (Json& image : listOf(root(), "images")) keepImage(image, index++);
}

void GltfRewriter::keepImage(Json& image, std::size_t index) {
  keepView(image, "bufferView");
  const GltfImage& external = document_.images.at(index);
  if (external.uri.empty()) return;
  std::string problem;
  const std::filesystem::path path = resolveUri(external.uri, external.folder, problem);
  if (!problem.empty()) return;  // as missing in the copy as it was
  constexpr std::size_t kLargest = std::size_t{1} << 31;
  auto kept = keptPictures_.find(path);
  if (kept == keptPictures_.end()) {
    const std::optional<std::vector<std::uint8_t>> bytes = readFileBytes(path, kLargest);
    if (!bytes) return;  // as missing in the copy as it was
    const bool isJpeg = bytes->size() > 1 && (*bytes)[0] == 0xff && (*bytes)[1] == 0xd8;
    const int added = builder_.addView(*bytes, GlbBuilder::kNoTarget);
    kept = keptPictures_.emplace(path, KeptPicture{added, isJpeg ? "image/jpeg" : "image/png"}).first;
  }
  image.erase("uri");
  image["bufferView"] = kept->second.view;
  if (!image.contains("mimeType")) image["mimeType"] = kept->second.mimeType;
}

int GltfRewriter::accessor(std::size_t old) {
  if (newAccessor_.at(old) >= 0) return newAccessor_[old];
  Json json = oldAccessors_[old];
  keepView(json, "bufferView");
  if (json.contains("sparse"))
    for (const char* part : {"indices", "values"}) keepView(json["sparse"][part], "bufferView");
  root()["accessors"].push_back(std::move(json));
  return newAccessor_[old] = static_cast<int>(root()["accessors"].size()) - 1;
}

int GltfRewriter::view(std::size_t old) {
  if (newView_.at(old) >= 0) return newView_[old];
  Json json = oldViews_[old];
  const std::size_t offset = json.value("byteOffset", std::size_t{0}),
                    length = json["byteLength"].get<std::size_t>();
  const GltfBuffer& buffer = document_.buffers.at(json["buffer"].get<std::size_t>());
  std::span<const std::uint8_t> bytes;
  if (buffer.bytes && offset <= buffer.bytes->size() && length <= buffer.bytes->size() - offset)
    bytes = buffer.bytes->subspan(offset, length);
  const int index = builder_.addView(bytes, GlbBuilder::kNoTarget);
  Json& added = root()["bufferViews"].back();
  for (auto& item : json.items())
    if (!added.contains(item.key())) added[item.key()] = item.value();
  return newView_[old] = index;
}

int highestTexcoordSet(const Json& root) {
  return highestSet(root.value("materials", Json::array()));
}

}  // namespace limn::scene
