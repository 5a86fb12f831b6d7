// Writes what the fuzzers start from: small glTF files that use every part of the loader, and small meshes drawn by every
// method.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/scene/image.h"
#include "apps/scene/stored_curves.h"
#include "tests/scene/gltf_writer.h"

namespace {

using limn::scene::test::GltfWriter;
using limn::scene::test::json;

GltfWriter indexed() {
  GltfWriter w;
  const json attributes = {
      {"POSITION", w.addArray<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3")},
      {"COLOR_0", w.addArray<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 128},
                                           "VEC4", true)}};
  w.addMesh(attributes, w.addArray<std::uint16_t>({0, 1, 3, 2}, "SCALAR"), 5);
  w.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  w.root["nodes"].push_back({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}});
  w.root["scenes"] = {{{"nodes", {0, 1}}}};
  w.root["scene"] = 0;
  return w;
}

GltfWriter sparse() {
  GltfWriter w;
  const json replaced = {{"count", 1},
                         {"indices", {{"bufferView", w.addView<std::uint8_t>({2})}, {"componentType", 5121}}},
                         {"values", {{"bufferView", w.addView<float>({0, 1, 0})}}}};
  const int positions =
      w.addAccessor({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", replaced}});
  w.addMesh({{"POSITION", positions}}, -1, 6);
  return w;
}

GltfWriter skinned() {
  GltfWriter w;
  json& primitive = w.addTriangle();
  json& attributes = primitive["attributes"];
  attributes["JOINTS_0"] = w.addArray<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = w.addArray<float>({1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
  primitive["targets"] = {{{"POSITION", w.addArray<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}};
  w.root["skins"] = {{{"joints", {1, 2}}}};
  w.root["nodes"][0]["skin"] = 0;
  w.root["nodes"].push_back({{"children", {2}}, {"rotation", {0, 0, 0, 1}}});
  w.root["nodes"].push_back({{"translation", {1, 0, 0}}});
  const int times = w.addArray<float>({0, 1}, "SCALAR");
  const json samplers = {
      {{"input", times}, {"output", w.addArray<std::int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", true)}},
      {{"input", times},
       {"output", w.addArray<float>({0, 0, 0, 0, 1, 0}, "SCALAR")},
       {"interpolation", "CUBICSPLINE"}}};
  w.root["animations"] = {{{"samplers", samplers},
                           {"channels",
                            {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}},
                             {{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  return w;
}

GltfWriter textured() {
  GltfWriter w;
  json& primitive = w.addTriangle();
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = w.addArray<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  const limn::scene::Image pixels{1, 1, {10, 20, 30, 40}};
  w.root["images"] = {
      {{"bufferView", w.addView(limn::scene::encodePng(pixels, {}, 1))}, {"mimeType", "image/png"}}};
  w.root["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
  w.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const json transform = {
      {"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}, {"scale", {2, 2}}}}};
  w.root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}}, {"metallicFactor", 0}}},
       {"normalTexture", {{"index", 0}}},
       {"alphaMode", "BLEND"},
       {"extensions", {{"KHR_materials_unlit", json::object()}}}}};
  w.root["extensions"] = {
      {"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", json::object()}}}}}}};
  w.root["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  return w;
}

/// A triangle with fitted curves: two ends per edge, one centre.
GltfWriter fitted() {
  GltfWriter w;
  w.addTriangle();
  limn::scene::StoredCurves curves;
  curves.ends.assign(6, {10, -20, 30});
  curves.centers.assign(1, {0, 0, 60});
  curves.endScale = curves.centerScale = glm::vec3(0.25f);
  const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<std::int8_t> ends;
  for (const auto& end : curves.ends) ends.insert(ends.end(), end.begin(), end.end());
  const json scale = {0.25, 0.25, 0.25};
  w.root["meshes"][0]["extensions"]["LIMN_fitted_curves"] = {
      {"ends", w.addArray(ends, "VEC3", true)},
      {"endScale", scale},
      {"centers", w.addArray<std::int8_t>({0, 0, 60}, "VEC3", true)},
      {"centerScale", scale},
      {"key", limn::scene::curvesKey(curves, corners)}};
  w.root["extensionsUsed"] = {"LIMN_fitted_curves"};
  return w;
}

/// A mesh for the frame target (frame_input.h): the first two bytes, then a closed or open one of whole coordinates.
std::vector<std::uint8_t> frame(int first, int second, const std::vector<std::int8_t>& coordinates,
                                const std::vector<std::uint8_t>& indices) {
  const auto byte = [](std::size_t value) { return static_cast<std::uint8_t>(value); };
  const std::size_t vertices = coordinates.size() / 3;
  std::vector<std::uint8_t> bytes = {byte(static_cast<std::size_t>(first)),
                                     byte(static_cast<std::size_t>(second)),
                                     0,
                                     8,
                                     8,
                                     30,
                                     20,
                                     0,
                                     0,
                                     byte(vertices - 3),
                                     byte(indices.size() / 3 - 1)};
  for (const std::int8_t c : coordinates) {
    bytes.push_back(static_cast<std::uint8_t>(c));
    bytes.push_back(c < 0 ? 255 : 0);
  }
  if ((second & 4) != 0)
    for (const std::int8_t c : coordinates) bytes.push_back(static_cast<std::uint8_t>(c));  // as on a sphere
  if ((second & 8) != 0) bytes.insert(bytes.end(), 4 * vertices, 40);
  bytes.insert(bytes.end(), indices.begin(), indices.end());
  return bytes;
}

const std::vector<std::int8_t> kOctahedron = {90, 0, 0, -90, 0, 0, 0, 90, 0, 0, -90, 0, 0, 0, 90, 0, 0, -90};
const std::vector<std::uint8_t> kOctahedronFaces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                                    2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
const std::vector<std::int8_t> kFold = {0, 0, 0, 60, 0, 0, 60, 60, 10, 0, 60, 0, 30, 30, 50, 0, 0, 0};
const std::vector<std::uint8_t> kFoldFaces = {0, 1, 2, 0, 2, 3, 5, 2, 4, 4, 4, 1};

bool write(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return static_cast<bool>(file.flush());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: limn_fuzz_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = std::filesystem::path(argv[1]) / "loader";
  const std::filesystem::path frames = std::filesystem::path(argv[1]) / "frame";
  std::filesystem::create_directories(folder);
  std::filesystem::create_directories(frames);
  const std::string embedded =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
  bool written =
      write(folder / "indexed.glb", indexed().glb()) && write(folder / "sparse.glb", sparse().glb()) &&
      write(folder / "skinned.glb", skinned().glb()) && write(folder / "textured.glb", textured().glb()) &&
      write(folder / "fitted.glb", fitted().glb()) &&
      write(folder / "embedded.gltf", {embedded.begin(), embedded.end()});
  for (int method = 0; method < 4; ++method) {
    const std::string name = std::to_string(method);
    written = written &&
              write(frames / ("closed-" + name), frame(method | 24, 2 | 4, kOctahedron, kOctahedronFaces)) &&
              write(frames / ("open-" + name), frame(method | 36, 8 | 16 | 64 | 128, kFold, kFoldFaces));
  }
  if (!written) std::fputs("limn_fuzz_seeds: could not write the seeds\n", stderr);
  return written ? 0 : 4;
}
