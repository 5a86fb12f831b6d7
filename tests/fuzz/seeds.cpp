// Writes small glTF files that use every part of the loader: what the fuzzer starts from.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/scene/image.h"
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
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const std::string embedded =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
  const bool written =
      write(folder / "indexed.glb", indexed().glb()) && write(folder / "sparse.glb", sparse().glb()) &&
      write(folder / "skinned.glb", skinned().glb()) && write(folder / "textured.glb", textured().glb()) &&
      write(folder / "embedded.gltf", {embedded.begin(), embedded.end()});
  if (!written) std::fputs("limn_fuzz_seeds: could not write the seeds\n", stderr);
  return written ? 0 : 4;
}
