#include "apps/limn/manifest.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "apps/limn/values.h"
#include "apps/scene/image.h"
#include "apps/scene/load.h"

namespace limn::program {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw scene::InputError(path + ": " + what + "; give a file that `limn render --manifest` wrote");
}

/// The value at a JSON pointer, of the type that `T` says.
template <class T>
T value(const Json& json, const std::string& pointer, const std::string& path) {
  const Json::json_pointer place(pointer);
  if (!json.contains(place)) refuse(path, pointer + ": is missing");
  try {
    if (!std::is_same_v<T, int> || json.at(place).is_number_integer()) return json.at(place).get<T>();
  } catch (const Json::exception&) {  // said below
  }
  refuse(path, pointer + ": is of another kind");
}

Json parseFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path))
    throw scene::InputError(path + ": cannot be read as a file; is the name right?");
  try {
    return Json::parse(file);
  } catch (const Json::parse_error& error) {
    refuse(path, "byte " + std::to_string(error.byte) + ": is no JSON");
  }
}

}  // namespace

std::string Manifest::json() const {
  Json json;
  json["limn"] = LIMN_VERSION;
  json["job"] = job;
  json["list"] = list;
  json["shard"] = std::to_string(shard.first) + "/" + std::to_string(shard.second);
  json["format"] = rgba ? "rgba" : "png";
  json["size"] = {width, height};
  json["aov"] = aovs;
  json["pixels"] = jobHash(frames);
  json["frames"] = Json::array();
  for (const ManifestFrame& f : frames) {
    Json entry = {{"frame", f.frame}, {"file", f.file}, {"pixels", f.pixels}};
    if (!f.aovs.empty()) entry["aov"] = f.aovs;
    json["frames"].push_back(std::move(entry));
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Manifest Manifest::read(const std::string& path) {
  const Json json = parseFile(path);
  if (!json.is_object()) refuse(path, "holds no manifest");
  Manifest manifest;
  manifest.job = value<std::string>(json, "/job", path);
  manifest.list = value<std::string>(json, "/list", path);
  manifest.rgba = value<std::string>(json, "/format", path) == "rgba";
  manifest.width = value<int>(json, "/size/0", path);
  manifest.height = value<int>(json, "/size/1", path);
  manifest.aovs = value<std::vector<std::string>>(json, "/aov", path);
  try {
    manifest.shard = parseShard(value<std::string>(json, "/shard", path));
    FrameList::parse(manifest.list);
  } catch (const UsageError& error) {
    refuse(path, std::string("/shard or /list: ") + error.what());
  }
  const auto count = value<Json>(json, "/frames", path).size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string place = "/frames/" + std::to_string(i);
    ManifestFrame frame;
    frame.frame = value<int>(json, place + "/frame", path);
    frame.file = value<std::string>(json, place + "/file", path);
    frame.pixels = value<std::string>(json, place + "/pixels", path);
    if (!manifest.aovs.empty()) frame.aovs = value<std::vector<std::string>>(json, place + "/aov", path);
    if (frame.aovs.size() != manifest.aovs.size()) refuse(path, place + "/aov: is not one hash per kind");
    manifest.frames.push_back(std::move(frame));
  }
  if (value<std::string>(json, "/pixels", path) != jobHash(manifest.frames))
    refuse(path, "/pixels: does not match the frames; the file was changed");
  return manifest;
}

std::string jobHash(std::vector<ManifestFrame> frames) {
  std::sort(frames.begin(), frames.end(),
            [](const ManifestFrame& a, const ManifestFrame& b) { return a.frame < b.frame; });
  std::string lines;
  for (const ManifestFrame& f : frames) lines += std::to_string(f.frame) + " " + f.pixels + "\n";
  return scene::hashBytes(lines.data(), lines.size());
}

std::string relativeTo(const std::string& manifest, const std::string& path) {
  const fs::path folder = fs::absolute(manifest).parent_path().lexically_normal();
  return fs::absolute(path).lexically_normal().lexically_proximate(folder).string();
}

std::string besideManifest(const std::string& manifest, const std::string& file) {
  return (fs::path(manifest).parent_path() / file).lexically_normal().string();
}

}  // namespace limn::program
