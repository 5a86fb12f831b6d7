#include "apps/scene/gltf_document.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/scene/gltf_container.h"
#include "apps/scene/gltf_uri.h"
#include "apps/scene/input_file.h"
#include "apps/scene/load.h"

namespace limn::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using Folder = std::optional<fs::path>;
using Binary = std::optional<std::span<const std::uint8_t>>;

std::string textOf(const json& object, const char* name) {
  const auto member = object.find(name);
  return member == object.end() ? std::string() : member->get<std::string>();
}

std::vector<std::uint8_t> decodedOrRefused(const GltfDocument& document, const std::string& uri,
                                           const std::string& place) {
  std::optional<std::vector<std::uint8_t>> bytes = decodeDataUri(uri);
  if (!bytes)
    document.refuse(place, "is no base64 data URI; write \"data:application/octet-stream;base64,...\"");
  return std::move(*bytes);
}

// Refuses what a file must not name, whether it is there or not.
void checkUri(const GltfDocument& document, const std::string& uri, const Folder& folder,
              const std::string& place) {
  if (!folder) {
    document.refuse(place, "names a file, but a model on standard input has none beside it; embed it");
  }
  const std::string problem = uriProblem(uri);
  if (!problem.empty()) document.refuse(place, inQuotes(uri) + " " + problem);
}

fs::path pathOrRefused(const GltfDocument& document, const std::string& uri, const Folder& folder,
                       const std::string& place) {
  checkUri(document, uri, folder, place);
  std::string problem;
  fs::path path = resolveUri(uri, *folder, problem);
  if (!problem.empty()) document.refuse(place, inQuotes(uri) + " " + problem);
  return path;
}

/// A file that buffers name: read once however many do, as far as the longest of them.
struct BufferFile {
  std::size_t length = 0, firstBuffer = 0;
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};
using BufferFiles = std::map<fs::path, BufferFile>;

/// The entry of each buffer's file, null where it has none; nothing is read yet.
std::vector<BufferFile*> findBufferFiles(const GltfDocument& document, const json& described,
                                         const Folder& folder, BufferFiles& files) {
  std::vector<BufferFile*> fileOf;
  for (const json& buffer : described) {
    const std::string uri = textOf(buffer, "uri");
    const std::string place = jsonPointer("buffers", fileOf.size(), "uri");
    fileOf.push_back(nullptr);
    if (!buffer.contains("uri") || isDataUri(uri)) continue;
    const auto [entry, isNew] = files.try_emplace(pathOrRefused(document, uri, folder, place));
    BufferFile& file = entry->second;
    if (isNew) file.firstBuffer = fileOf.size() - 1;
    file.length = std::max(file.length, buffer["byteLength"].get<std::size_t>());
    fileOf.back() = &file;
  }
  return fileOf;
}

GltfBuffer readBuffer(const GltfDocument& document, std::size_t index, const json& described,
                      const BufferFile* file, const Binary& binary) {
  GltfBuffer buffer;
  buffer.length = described["byteLength"].get<std::size_t>();
  const std::string place = jsonPointer("buffers", index, "uri");
  if (file != nullptr)
    buffer.source = file->bytes;
  else if (described.contains("uri"))
    buffer.source = std::make_shared<const std::vector<std::uint8_t>>(
        decodedOrRefused(document, textOf(described, "uri"), place));
  else if (index == 0)
    buffer.bytes = binary;
  if (buffer.source) buffer.bytes = *buffer.source;
  if (!buffer.bytes) return buffer;
  if (buffer.bytes->size() < buffer.length) {
    document.refuse(jsonPointer("buffers", index, "byteLength"),
                    "is " + std::to_string(buffer.length) + ", but there are only " +
                        std::to_string(buffer.bytes->size()) + " bytes; is the file whole?");
  }
  buffer.bytes = buffer.bytes->first(buffer.length);
  return buffer;
}

GltfImage readImage(const GltfDocument& document, std::size_t index, const json& described,
                    const Folder& folder) {
  GltfImage image;
  const std::string uri = textOf(described, "uri"), place = jsonPointer("images", index, "uri");
  if (const auto view = described.find("bufferView"); view != described.end())
    image.bufferView = view->get<int>();
  else if (isDataUri(uri))
    image.embedded = decodedOrRefused(document, uri, place);
  else if (described.contains("uri")) {
    checkUri(document, uri, folder, place);
    image.uri = uri;
    image.folder = *folder;
  }
  return image;
}

// Calls refuseBadOne(index, item) for every item of a list of the document, which may be missing.
template <class Check>
void forAll(const json& document, const char* list, const Check& refuseBadOne) {
  const auto found = document.find(list);
  if (found == document.end()) return;
  std::size_t index = 0;
  for (const json& item : *found) refuseBadOne(index++, item);
}

// With the place, which tinygltf does not tell.
void refuseWhatTinygltfDoes(const GltfDocument& file, const json& document) {
  forAll(document, "bufferViews", [&](std::size_t index, const json& view) {
    if (view.value("byteStride", 4) % 4 != 0)
      file.refuse(jsonPointer("bufferViews", index, "byteStride"), "must be a multiple of 4");
  });
  forAll(document, "cameras", [&](std::size_t index, const json& camera) {
    const std::string kind = textOf(camera, "type");
    if (!camera.contains(kind)) file.refuse(jsonPointer("cameras", index, kind), "is missing");
  });
}

// Takes out what tinygltf is not to see, and puts what it refuses although glTF allows it into a form that it
// takes: it refuses index accessors without a view (all zeros), so they get one beyond the file's. Returns
// the file's number.
std::size_t adaptForTinygltf(json& document) {
  document.erase("buffers");
  document.erase("images");
  json& views = document["bufferViews"];
  if (views.is_null()) views = json::array();
  const std::size_t viewCount = views.size();
  if (!document.contains("accessors")) return viewCount;
  for (json& accessor : document["accessors"]) {
    if (!accessor.contains("bufferView")) accessor["bufferView"] = viewCount;
  }
  views.push_back({{"buffer", 0}, {"byteLength", 0}});
  return viewCount;
}

}  // namespace

GltfDocument::GltfDocument(std::string file, std::vector<std::uint8_t> bytes, const Folder& folder)
    : file_(std::move(file)), bytes_(std::move(bytes)) {
  const Container container = splitContainer(file_, bytes_, notices);
  parse(container.jsonOffset, container.json, folder, container.binary);
}

void GltfDocument::parse(std::size_t jsonOffset, std::string_view text, const Folder& folder, Binary binary) {
  json document = parseGltfJson(file_, text, jsonOffset, notices);
  inputBytes_ = bytes_.size();
  if (document.contains("buffers")) readBuffers(document["buffers"], folder, binary);
  if (document.contains("images")) {
    for (const json& image : document["images"])
      images.push_back(readImage(*this, images.size(), image, folder));
  }
  budget_ = Budget(inputBytes_);
  refuseWhatTinygltfDoes(*this, document);
  viewCount = adaptForTinygltf(document);
  const std::string checked = document.dump();
  document = nullptr;
  tinygltf::TinyGLTF parser;
  std::string errors, warnings;
  const bool parsed = parser.LoadASCIIFromString(&model, &errors, &warnings, checked.data(),
                                                 static_cast<unsigned int>(checked.size()), "");
  if (!parsed) refuse("/", "tinygltf cannot read it and says " + inQuotes(errors) + "; write the file anew");
}

void GltfDocument::readBuffers(const json& described, const Folder& folder, const Binary& binary) {
  BufferFiles files;
  const std::vector<BufferFile*> fileOf = findBufferFiles(*this, described, folder, files);
  for (auto& [path, file] : files) {
    std::optional<std::vector<std::uint8_t>> bytes = readFileBytes(path, file.length);
    if (!bytes)
      refuse(jsonPointer("buffers", file.firstBuffer, "uri"),
             inQuotes(textOf(described[file.firstBuffer], "uri")) + " cannot be read; may you read it?");
    inputBytes_ += bytes->size();
    counted_.insert(path);
    file.bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(*bytes));
  }
  for (const json& buffer : described) {
    const std::size_t index = buffers.size();
    buffers.push_back(readBuffer(*this, index, buffer, fileOf[index], binary));
    if (fileOf[index] == nullptr && buffers.back().source) inputBytes_ += buffers.back().source->size();
  }
}

void GltfDocument::refuse(const std::string& place, const std::string& what) const {
  throw InputError(file_ + ": " + place + ": " + what);
}

void GltfDocument::checkRoom(std::size_t bytes, const std::string& place) const {
  if (bytes <= budget_.left()) return;
  refuse(place, "needs " + std::to_string(bytes >> 20) + " MiB more where " +
                    std::to_string(budget_.left() >> 20) +
                    " MiB are left to a file of this size; is the count or size right?");
}

void GltfDocument::charge(std::size_t bytes, const std::string& place) {
  checkRoom(bytes, place);
  budget_.take(bytes);
}

}  // namespace limn::scene
